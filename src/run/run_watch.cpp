#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "analysis/body_overlap.h"
#include "analysis/course.h"
#include "analysis/flat_cells.h"
#include "aspic/analysis.h"
#include "aspic/run.h"
#include "run/energy_watch.h"
#include "run/named_bodies.h"
#include "run/start_diagnostics.h"

namespace aspic {
namespace {

/// Of simulated time, between two looks [s].
constexpr double interval = 0.1;

}  // namespace

std::string Diagnostic::sentence() const {
  return advice.empty() ? text + "." : fmt::format("{}. {}.", text, advice);
}

struct RunWatch::Parts {
  std::vector<std::string> names;  // of bodies
  std::vector<BodyOverlap> at_start;
  std::vector<Diagnostic> start;       // the rest of what is told there
  std::optional<DeepPoints> deep;      // made with the first look, since they take much of the memory of
  std::optional<FlatCellSearch> flat;  // a run, and scene check makes none
  double timestep;
  bool watched;                       // there is something to look for
  std::optional<EnergyWatch> energy;  // of the first look's model
  std::set<std::pair<std::uint32_t, std::uint32_t>> told_pairs;
  std::set<std::uint32_t> told_flat;
  bool told_energy = false;
  bool starts = false;  // in the model's initial state

  std::string pair(const BodyOverlap& of) const {
    return fmt::format("{} and {}", names.at(of.a), names.at(of.b));
  }
  std::string when(const State& state) const {
    return fmt::format("at step {} (t = {:.4g} s)", state.step, static_cast<double>(state.step) * timestep);
  }
  Diagnostic overlap() const;
  void look_for_deep(const State& state, std::vector<Diagnostic>& found);
  void look_for_flat(const State& state, std::vector<Diagnostic>& found);
  void look_for_energy(const State& state, const InputLog& inputs, std::vector<Diagnostic>& found);
};

RunWatch::RunWatch(const ModelSettings& settings, const Model& model, bool starts, Precision precision)
    : parts_(new Parts{
          followable_bodies(settings),
          starts ? overlaps_of(model, initial_state(model, Precision::double_)) : std::vector<BodyOverlap>(),
          starts ? start_diagnostics(settings, model, precision) : std::vector<Diagnostic>(),
          {},
          {},
          model.simulation.timestep,
          !model.bodies.empty(),
          {},
          {},
          {}}) {
  // What is deep from the start is named there.
  for (const BodyOverlap& each : parts_->at_start)
    if (each.locked()) parts_->told_pairs.emplace(each.a, each.b);
  parts_->starts = starts;
}

RunWatch::RunWatch(RunWatch&&) noexcept = default;
RunWatch& RunWatch::operator=(RunWatch&&) noexcept = default;
RunWatch::~RunWatch() = default;

void RunWatch::knows_what(const RunWatch& other) {
  if (parts_->names != other.parts_->names) return;
  parts_->told_pairs = other.parts_->told_pairs;
  parts_->told_flat = other.parts_->told_flat;
  parts_->told_energy = other.parts_->told_energy;
}

Diagnostic RunWatch::Parts::overlap() const {
  std::vector<std::string> pairs;
  for (const BodyOverlap& each : at_start)
    pairs.push_back(fmt::format(
        "{} by {:.3g} m{}{}", pair(each), each.deepest,
        each.locked() ? fmt::format(", deeper than the {:.3g} m up to which contact acts", each.most) : "",
        each.energy > 0.0 ? fmt::format(", {:.3g} J", each.energy) : ""));
  const bool locked = std::ranges::any_of(at_start, &BodyOverlap::locked);
  const std::string count =
      at_start.size() == 1 ? std::string("two bodies") : fmt::format("{} pairs of bodies", at_start.size());
  return {"overlap", names.at(at_start.front().a),
          fmt::format("{} overlap at the start: {}", count, listed(pairs)),
          fmt::format("{}; move them apart in the scene",
                      locked ? "Deep overlaps remain; shallow ones separate slowly"
                             : "They separate slowly, without the energy given")};
}

std::vector<Diagnostic> RunWatch::at_start() const {
  std::vector<Diagnostic> found;
  if (!parts_->at_start.empty()) found.push_back(parts_->overlap());
  found.insert(found.end(), parts_->start.begin(), parts_->start.end());
  return found;
}

void RunWatch::Parts::look_for_deep(const State& state, std::vector<Diagnostic>& found) {
  const auto known = [&](std::uint32_t a, std::uint32_t b) {
    return told_pairs.contains({std::min(a, b), std::max(a, b)});
  };
  std::vector<std::string> pairs;
  std::string where;
  for (const BodyOverlap& each : deep->find(state, known)) {
    pairs.push_back(
        fmt::format("{} by {:.3g} m, and contact acts up to {:.3g} m", pair(each), each.deepest, each.most));
    if (where.empty()) where = names.at(each.a);
    told_pairs.emplace(each.a, each.b);
  }
  if (pairs.empty()) return;
  found.push_back(
      {"deep-overlap", where,
       fmt::format("bodies interpenetrate beyond the contact range {} and will stay stuck: {}", when(state),
                   listed(pairs)),
       "Their impact is too fast or their springs too soft: see the contact lines of aspic scene check"});
}

void RunWatch::Parts::look_for_flat(const State& state, std::vector<Diagnostic>& found) {
  std::vector<std::string> bodies;
  std::string where;
  for (const FlatCells& each : flat->find(state)) {
    if (!told_flat.insert(each.body).second) continue;
    if (where.empty()) where = names.at(each.body);
    bodies.push_back(fmt::format("{} of {}", each.cells, names.at(each.body)));
  }
  if (bodies.empty()) return;
  found.push_back({"flat-cells", where,
                   fmt::format("cells are flat or inverted {}: {}", when(state), listed(bodies)),
                   "Springs may hold them in this state; slower impacts or stiffer springs keep the shape"});
}

void RunWatch::Parts::look_for_energy(const State& state, const InputLog& inputs,
                                      std::vector<Diagnostic>& found) {
  const auto rise = energy->look(state, inputs);
  if (!rise) return;
  told_energy = true;
  const std::string before =
      rise->driven ? fmt::format(
                         "above that of step {} plus an upper bound of the work of actuators, pulls and "
                         "moving terrain since",
                         rise->since)
                   : fmt::format("more than at {}, without any work done",
                                 rise->since > 0 ? fmt::format("step {}", rise->since) : "the start");
  found.push_back({"energy", "",
                   fmt::format("the total energy is {:.3g} J {}, {:.3g} J {}", rise->total, when(state),
                               rise->excess, before),
                   "Impacts are too fast or the time step is too large: see aspic scene check"});
}

std::vector<Diagnostic> RunWatch::look(const Model& model, const State& state, const InputLog& inputs,
                                       bool anew) {
  std::vector<Diagnostic> found;
  if (!parts_->deep) {
    parts_->deep.emplace(model);
    parts_->flat.emplace(model);
    // Bodies that are eased apart gain energy, those within terrain in the first step.
    if (parts_->at_start.empty()) parts_->energy.emplace(model, interval);
    if (parts_->energy && parts_->starts &&
        std::ranges::find(parts_->start, "within-terrain", &Diagnostic::id) == parts_->start.end())
      parts_->energy->begin(initial_state(model, Precision::double_), inputs);
  }
  parts_->look_for_deep(state, found);
  parts_->look_for_flat(state, found);
  if (parts_->energy && anew)
    parts_->energy->begin(state, inputs);
  else if (parts_->energy && !parts_->told_energy)
    parts_->look_for_energy(state, inputs, found);
  for (Diagnostic& each : found) each.step = state.step;
  return found;
}

std::uint64_t RunWatch::next_step(std::uint64_t step) const {
  if (!parts_->watched) return std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t every = sample_stride(parts_->timestep, interval);
  return step + (every - step % every);
}

}  // namespace aspic
