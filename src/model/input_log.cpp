#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "aspic/inputs.h"
#include "aspic/solver.h"
#include "base/fnv.h"
#include "base/result.h"
#include "model/inputs.h"

namespace aspic {

std::uint64_t step_at_same_time(std::uint64_t step, double from, double to) {
  if (from == to) return step;
  constexpr double last = 9007199254740992.0;  // 2⁵³: as far as double precision counts
  const double at = std::nearbyint(static_cast<double>(step) * from / to);
  return static_cast<std::uint64_t>(at >= 0.0 && at < last ? at : last);
}

void InputLog::set(std::uint64_t step, Inputs inputs) {
  forget_from(step);
  if (inputs == at(step)) return;
  entries_.push_back({step, std::move(inputs)});
}

void InputLog::forget_from(std::uint64_t step) {
  const auto first = std::ranges::lower_bound(entries_, step, {}, &Entry::step);
  entries_.erase(first, entries_.end());
}

const Inputs& InputLog::at(std::uint64_t step) const {
  static const Inputs none;
  const auto later = std::ranges::upper_bound(entries_, step, {}, &Entry::step);
  return later == entries_.begin() ? none : std::prev(later)->inputs;
}

std::optional<std::uint64_t> InputLog::next_change(std::uint64_t step) const {
  const auto later = std::ranges::upper_bound(entries_, step, {}, &Entry::step);
  return later == entries_.end() ? std::nullopt : std::optional(later->step);
}

InputLog InputLog::with_timestep(double from, double to) const {
  if (from == to) return *this;
  InputLog result;
  for (const Entry& entry : entries_) result.set(step_at_same_time(entry.step, from, to), entry.inputs);
  return result;
}

std::uint64_t InputLog::hash() const {
  Fnv1a hash;
  const auto add_count = [&](std::size_t count) { hash.add(static_cast<std::uint64_t>(count)); };
  const auto add_particles = [&](const std::vector<std::uint32_t>& particles) {
    add_count(particles.size());
    for (const std::uint32_t particle : particles) hash.add(particle);
  };
  for (const Entry& entry : entries_) {
    hash.add(entry.step);
    add_count(entry.inputs.pulls.size());
    for (const Pull& pull : entry.inputs.pulls) {
      hash.add(pull.particle);
      hash.add(std::uint32_t{pull.ball});
      for (int axis = 0; axis < 3; ++axis) hash.add(pull.anchor[axis]);
      hash.add(pull.stiffness);
      hash.add(pull.damping);
    }
    add_particles(entry.inputs.pinned);
    add_particles(entry.inputs.released);
    add_count(entry.inputs.channels.size());
    for (const double value : entry.inputs.channels) hash.add(value);
  }
  return hash.value();
}

std::string InputLog::hash_text() const {
  return fmt::format("{:016x}", hash());
}

std::uint64_t InputLog::bytes() const {
  std::uint64_t sum = entries_.capacity() * sizeof(Entry);
  for (const auto& [step, inputs] : entries_) {
    sum += inputs.pulls.capacity() * sizeof(Pull) + inputs.channels.capacity() * sizeof(double) +
           (inputs.pinned.capacity() + inputs.released.capacity()) * sizeof(std::uint32_t);
  }
  return sum;
}

Status check_log(const Model& model, const InputLog& log, Precision precision) {
  for (const InputLog::Entry& entry : log.entries()) {
    const auto taken = rounded_inputs(model, entry.inputs, precision);
    if (!taken) return fail(taken.error(), "inputs from step {} on: {}.", entry.step, taken.error().what);
  }
  return {};
}

Result<Advance> advance(Solver& solver, const InputLog& log, std::uint64_t step, std::uint64_t steps) {
  Advance all;
  while (all.steps < steps && !all.divergence && !all.stopped) {
    const std::uint64_t at = step + all.steps, end = step + steps;
    ASPIC_CHECK(solver.set_inputs(log.at(at)));
    ASPIC_TRY(Advance part, solver.advance(std::min(end, log.next_change(at).value_or(end)) - at));
    part.steps += all.steps;
    all = part;
  }
  if (!all.divergence) ASPIC_CHECK(solver.set_inputs(log.at(step + all.steps)));
  return all;
}

}  // namespace aspic
