#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "analysis/body_overlap.h"
#include "analysis/course.h"
#include "aspic/run.h"
#include "scene/follow.h"

namespace aspic {
namespace {

/// Pairs that a sentence names.
constexpr std::size_t most_named = 4;
/// Of simulated time, between two looks [s].
constexpr double interval = 0.1;

/// "a; b; c; and 3 more pairs"
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t n = 0; n < std::min(parts.size(), most_named); ++n) text += (n > 0 ? "; " : "") + parts[n];
  if (parts.size() > most_named) text += fmt::format("; and {} more", parts.size() - most_named);
  return text;
}

}  // namespace

struct OverlapWatch::Parts {
  std::vector<std::string> names;  // of bodies
  std::vector<BodyOverlap> at_start;
  DeepPoints deep;
  double timestep;
  bool touch;
  std::set<std::pair<std::uint32_t, std::uint32_t>> told;

  std::string pair(const BodyOverlap& of) const {
    return fmt::format("{} and {}", names.at(of.a), names.at(of.b));
  }
};

OverlapWatch::OverlapWatch(const ModelSettings& settings, const Model& model, bool starts)
    : parts_(new Parts{
          followable(settings, 0),
          starts ? overlaps_of(model, initial_state(model, Precision::double_)) : std::vector<BodyOverlap>(),
          DeepPoints(model),
          model.simulation.timestep,
          model.contact.bodies && bodies_touch(model),
          {}}) {
  // What is deep from the start is named there.
  for (const BodyOverlap& each : parts_->at_start)
    if (each.locked()) parts_->told.emplace(each.a, each.b);
}

OverlapWatch::OverlapWatch(OverlapWatch&&) noexcept = default;
OverlapWatch& OverlapWatch::operator=(OverlapWatch&&) noexcept = default;
OverlapWatch::~OverlapWatch() = default;

void OverlapWatch::knows_what(const OverlapWatch& other) {
  if (parts_->names == other.parts_->names) parts_->told = other.parts_->told;
}

std::string OverlapWatch::at_start() const {
  const std::vector<BodyOverlap>& all = parts_->at_start;
  if (all.empty()) return {};
  std::vector<std::string> pairs;
  for (const BodyOverlap& each : all)
    pairs.push_back(
        fmt::format("{} by {:.3g} m{}{}", parts_->pair(each), each.deepest,
                    each.locked() ? fmt::format(", deeper than the {:.3g} m that are pushed", each.most) : "",
                    each.energy > 0.0 ? fmt::format(", {:.3g} J", each.energy) : ""));
  const bool locked = std::ranges::any_of(all, &BodyOverlap::locked);
  return fmt::format(
      "{} overlap at the start: {}. {}; move them apart in the scene.",
      all.size() == 1 ? std::string("two bodies") : fmt::format("{} pairs of bodies", all.size()),
      listed(pairs),
      locked ? "What is too deep stays so, the rest is eased apart"
             : "They are eased apart slowly, without the energy named");
}

std::string OverlapWatch::look(const State& state) {
  const auto known = [&](std::uint32_t a, std::uint32_t b) {
    return parts_->told.contains({std::min(a, b), std::max(a, b)});
  };
  std::vector<std::string> pairs;
  for (const BodyOverlap& each : parts_->deep.find(state, known)) {
    pairs.push_back(fmt::format("{} by {:.3g} m, of {:.3g} m that are pushed", parts_->pair(each),
                                each.deepest, each.most));
    parts_->told.emplace(each.a, each.b);
  }
  if (pairs.empty()) return {};
  return fmt::format(
      "bodies are so deep within each other at step {} (t = {:.4g} s) that nothing pushes their inside "
      "apart: {}. "
      "They met too fast, or too soft: see what aspic scene check says of contact.",
      state.step, static_cast<double>(state.step) * parts_->timestep, listed(pairs));
}

std::uint64_t OverlapWatch::next_step(std::uint64_t step) const {
  if (!parts_->touch) return std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t every = sample_stride(parts_->timestep, interval);
  return step + (every - step % every);
}

}  // namespace aspic
