#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/stability.h"
#include "aspic/scene.h"
#include "cli/bench.h"
#include "cli/commands.h"
#include "model/cube.h"

namespace aspic::cli {
namespace {

/// The time step asked for: the scene's, or the largest sensible one.
Result<double> chosen_timestep(const BenchOptions& options, const Model& model) {
  const double own = model.simulation.timestep;
  if (options.timestep == BenchTimestep::scene) return own;
  // Where a method is stable at any step, accuracy and not stability sets its largest.
  const MethodTraits& traits = row_of(model.simulation.integrator).traits;
  if (traits.stable_at_any_step) return traits.nominal_step;
  const StabilityLimit limit = stability_limit(model, model.simulation.integrator, StabilityEffort::quick);
  if (!limit.step) {
    return fail(ErrorCode::scene_rejected, "--timestep largest: {}.",
                stability_sentence(model.simulation.integrator, limit));
  }
  return std::isfinite(*limit.step) ? 0.99 * *limit.step : own;
}

/// One size and integrator.
class Case {
 public:
  Case(const BenchOptions& options, const InterruptGuard& interrupt)
      : options_(options), interrupt_(interrupt) {}

  /// Makes everyone ready. Errors: of model, time step, backends and guests.
  Status prepare(ModelSettings settings, const InviteGuests& invite) {
    ASPIC_TRY(auto built, build_model(settings));
    ASPIC_TRY(built.simulation.timestep, chosen_timestep(options_, built));
    settings.simulation = simulation_ = built.simulation;
    const SharedModel model = shared(std::move(built));
    const int size = settings.cubes.empty() ? 0 : std::ranges::max(settings.cubes.front().lattice());
    const Integrator integrator = settings.simulation.integrator;
    for (const BackendChoice& choice : options_.backends) {
      if (!works_with(choice.force_path, integrator)) {
        print_message(fmt::format("skipped {} on the force path {}: it has no such path.",
                                  name_of(integrator), name_of(choice.force_path)));
        continue;
      }
      ASPIC_TRY(auto made, make_backend_contestant(choice, model, interrupt_));
      made->m.size = size;
      contestants_.push_back(std::move(made));
    }
    Guests guests;
    if (invite && !contestants_.empty()) {
      ASPIC_TRY(guests, invite(settings, *model, contestants_.front()->m, interrupt_));
    }
    std::ranges::move(guests.contestants, std::back_inserter(contestants_));
    for (const auto& contestant : contestants_) ASPIC_CHECK(set_steps(*contestant, guests.most_steps));
    return {};
  }

  /// Warms up and measures, everyone in turn, so that other work of the machine affects all alike.
  Status measure() {
    for (int repeat = -options_.warm_up; repeat < options_.repeats; ++repeat) {
      for (const auto& contestant : contestants_) {
        Measurement& m = contestant->m;
        if (m.divergence || (m.peer && !m.peer->passed)) continue;
        if (interrupt_.interrupted()) return Error{ErrorCode::interrupted, ""};
        ASPIC_TRY(const auto took, contestant->run(m.steps));
        if (repeat >= 0 && !m.divergence) m.repeats.push_back(took);
      }
    }
    for (const auto& contestant : contestants_) {
      if (contestant->m.counts()) ASPIC_CHECK(contestant->finish());
    }
    return {};
  }

  /// Rows of all that ran, also of those that were interrupted later.
  void take_rows(std::vector<Measurement>& rows) const {
    for (const auto& contestant : contestants_) {
      const Measurement& m = contestant->m;
      if (m.counts() || m.divergence || (m.peer && !m.peer->passed)) rows.push_back(m);
    }
  }

 private:
  Status set_steps(Contestant& contestant, std::uint64_t most) const {
    Measurement& m = contestant.m;
    if (m.peer && !m.peer->passed) return {};
    if (options_.duration) {
      ASPIC_TRY(const auto steps, steps_of({std::nullopt, options_.duration}, simulation_));
      m.steps = std::clamp<std::uint64_t>(steps, 1, most);
      return {};
    }
    ASPIC_TRY(m.steps, steps_for(contestant, options_.seconds / options_.repeats, most));
    return {};
  }

  const BenchOptions& options_;
  const InterruptGuard& interrupt_;
  SimulationSettings simulation_;
  std::vector<std::unique_ptr<Contestant>> contestants_;
};

/// All sizes and integrators, into the report.
Status measure_all(const BenchOptions& options, const Scene& loaded, const InterruptGuard& interrupt,
                   const InviteGuests& invite, BenchReport& report) {
  std::vector<int> sizes = options.sizes;
  if (!sizes.empty() && loaded.model.cubes.empty()) {
    return fail(ErrorCode::usage, "--size sets the particles-per-edge of cubes, but {} has no cube.",
                loaded.name);
  }
  if (sizes.empty()) sizes.push_back(0);
  std::vector<Integrator> integrators = options.integrators;
  if (integrators.empty()) integrators.push_back(loaded.model.simulation.integrator);
  for (const int size : sizes) {
    // Through the parser, so that a size out of range or past the memory is refused as in a file.
    std::vector<std::string> overrides;
    for (std::size_t c = 0; size > 0 && c < loaded.model.cubes.size(); ++c) {
      const CubeSettings& cube = loaded.model.cubes[c];
      overrides.push_back(cube.particles ? fmt::format("cube[{}].particles=[{}]", c,
                                                       fmt::join(with_longest_edge(cube, size), ","))
                                         : fmt::format("cube[{}].particles-per-edge={}", c, size));
    }
    ASPIC_TRY(auto scene, with_overrides(loaded, overrides));
    for (const Integrator integrator : integrators) {
      scene.model.simulation.integrator = integrator;
      Case measured(options, interrupt);
      Status status = measured.prepare(scene.model, invite);
      if (status) status = measured.measure();
      measured.take_rows(report.rows);
      ASPIC_CHECK(std::move(status));
    }
  }
  return {};
}

}  // namespace

Result<std::uint64_t> steps_for(Contestant& contestant, double seconds, std::uint64_t most) {
  double worked = 0.0;
  for (std::uint64_t steps = 1;;) {
    ASPIC_TRY(const auto took, contestant.run(steps));
    worked += took.seconds;
    if (contestant.m.divergence) return steps;
    const bool long_enough = took.seconds > seconds / 4;
    if (!long_enough && steps == most) return most;
    if (long_enough && worked >= warm_seconds) {
      const double wanted = static_cast<double>(steps) * seconds / took.seconds;
      return wanted < static_cast<double>(most)
                 ? std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted))
                 : most;
    }
    if (!long_enough) steps = std::min(2 * steps, most);
  }
}

std::string steps_warning(const Measurement& m, std::string_view option) {
  if (!m.counts() || m.steps >= fewest_steps) return "";
  return fmt::format(
      "{}, {} per edge, {}: a repeat has {} step{}; below {} the start and end of a run distort the result. "
      "Raise {}.",
      m.name, m.size, name_of(m.integrator), m.steps, m.steps == 1 ? "" : "s", fewest_steps, option);
}

Status execute(const BenchOptions& options) {
  return execute_bench(options);
}

Status execute_bench(const BenchOptions& options, const InviteGuests& invite) {
  const InterruptGuard interrupt;
  ASPIC_TRY(const auto loaded, load_scene(options.scene, options.overrides, by_set));
  if (options.images) return execute_images(options, loaded, interrupt);
  BenchReport report = {loaded.name, options.repeats, options.warm_up, false, {}};
  const Status measured = measure_all(options, loaded, interrupt, invite, report);
  report.interrupted = !measured && measured.error().code == ErrorCode::interrupted;
  if (!report.rows.empty() || measured.ok()) {
    compare_rows(report.rows);
    for (const Measurement& m : report.rows) {
      const std::string warning = steps_warning(m, options.duration ? "--duration" : "--seconds");
      if (!warning.empty()) print_warning(warning);
    }
    ASPIC_CHECK(options.json ? print_data(to_text(json_of(report))) : print_text(table_of(report)));
  }
  if (!report.interrupted) return measured;
  return Error{ErrorCode::interrupted, report.rows.empty()
                                           ? "interrupted; nothing was measured."
                                           : "interrupted; the rows have the measurements made before."};
}

}  // namespace aspic::cli
