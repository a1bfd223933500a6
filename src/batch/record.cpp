#include "batch/record.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/memory.h"
#include "base/result.h"
#include "model/model.h"

namespace aspic::batch {
namespace {

/// Beyond them time, which is step · h in double precision, no longer tells steps apart.
constexpr double most_steps = 9007199254740992.0;

/// Rows after the first: a duration that is a multiple of the interval has none shortly before its end.
double rows_after(double duration, double interval) {
  return std::ceil(duration / interval * (1.0 - 1e-12));
}

/// The start, every interval, the end.
std::vector<double> times_of(double duration, double interval) {
  std::vector<double> times = {0.0};
  const auto rows = static_cast<std::uint64_t>(rows_after(duration, interval));
  for (std::uint64_t n = 1; n < rows; ++n) times.push_back(static_cast<double>(n) * interval);
  if (duration > 0.0) times.push_back(duration);
  return times;
}

/// Bytes of a record, in double precision: there may be too many to count.
double bytes_of(double instances, double rows, std::size_t particles, const BatchQuantities& quantities) {
  const int numbers = 1 + (quantities.center_of_mass ? 3 : 0) + (quantities.momentum ? 3 : 0) +
                      (quantities.energies ? 3 : 0) + (quantities.actuator_work ? 1 : 0);
  return instances * rows * (8.0 * numbers + 12.0 * static_cast<double>(particles)) + 8.0 * rows;
}

Vec3 center_of_mass(const Model& model, const State& state) {
  Vec3 sum;
  double all = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    sum = sum + model.mass[i] * state.position[i];
    all += model.mass[i];
  }
  return all > 0.0 ? 1.0 / all * sum : Vec3{};
}

}  // namespace

Result<Recording> Recording::plan(const std::vector<SharedModel>& models, double duration, double interval,
                                  const BatchQuantities& quantities) {
  if (!(duration >= 0.0) || !std::isfinite(duration))
    return fail(ErrorCode::usage, "a batch runs for 0 s or more, not for {} s", duration);
  if (!(interval > 0.0) || !std::isfinite(interval))
    return fail(ErrorCode::usage, "the interval of records is more than 0 s, not {} s", interval);
  Recording plan;
  plan.quantities_ = quantities;
  BatchRecord& record = plan.record_;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Model& model = *models[i];
    if (!(duration / model.simulation.timestep < most_steps))
      return fail(ErrorCode::usage, "{} s of instance {} are more than 2^53 steps", duration, i);
    if (!quantities.body) continue;
    if (*quantities.body >= model.bodies.size())
      return fail(ErrorCode::usage, "instance {} has no body {}: it has {}, numbered from 0", i,
                  *quantities.body, model.bodies.size());
    const Body& body = model.bodies[*quantities.body];
    if (i > 0 && body.particle_count != record.particles)
      return fail(
          ErrorCode::usage,
          "body {} has {} particles in instance 0 and {} in instance {}: positions are recorded where "
          "all have as many",
          *quantities.body, record.particles, body.particle_count, i);
    record.particles = body.particle_count;
    plan.first_.push_back(body.first_particle);
  }
  const auto no_memory = [&] {
    return fail(ErrorCode::scene_rejected,
                "not enough memory for the record of {} instances every {} s: record less often",
                models.size(), interval);
  };
  const double bytes = bytes_of(static_cast<double>(models.size()), 1.0 + rows_after(duration, interval),
                                record.particles, quantities);
  if (const auto left = available_memory(); left && bytes > static_cast<double>(*left)) return no_memory();
  try {
    plan.times_ = times_of(duration, interval);
    record.instances = models.size();
    record.times = plan.times_.size();
    const std::size_t rows = record.instances * record.times;
    record.time.resize(rows);
    if (quantities.center_of_mass) record.center_of_mass.resize(3 * rows);
    if (quantities.momentum) record.momentum.resize(3 * rows);
    if (quantities.energies) {
      record.energy.resize(3 * rows);
      for (const SharedModel& model : models) plan.meters_.emplace_back(*model);
    }
    if (quantities.actuator_work) {
      record.actuator_work.resize(rows);
      plan.works_.resize(record.instances);
    }
    record.positions.resize(3 * rows * record.particles);
    record.diverged.resize(record.instances);
    record.hash.resize(record.instances);
  } catch (const std::exception&) {  // of vectors: no memory, or more than there can be
    return no_memory();
  }
  return plan;
}

Status Recording::take(Unit& unit, std::span<const std::size_t> instances, const std::atomic<bool>* flag) {
  const auto first = std::ranges::find_if(instances, [](std::size_t i) { return i != nobody; });
  if (first == instances.end()) return {};
  const double h = unit.model(static_cast<std::size_t>(first - instances.begin()))->simulation.timestep;
  std::uint64_t done = 0;
  for (std::size_t row = 0; row < times_.size(); ++row) {
    const auto wanted = static_cast<std::uint64_t>(std::llround(times_[row] / h));
    ASPIC_CHECK(unit.advance(wanted - done));
    done = wanted;
    if (flag && flag->load(std::memory_order_relaxed)) return {};
    for (std::size_t slot = 0; slot < instances.size(); ++slot)
      if (instances[slot] != nobody) write(unit, slot, instances[slot], row);
  }
  return {};
}

/// A row of an instance, which is at the step to be recorded or at its last good one.
void Recording::write(const Unit& unit, std::size_t slot, std::size_t instance, std::size_t row) {
  const SharedModel model = unit.model(slot);
  const std::size_t at = instance * record_.times + row;
  const auto put = [&](std::vector<double>& to, double a, double b, double c) {
    to[3 * at] = a;
    to[3 * at + 1] = b;
    to[3 * at + 2] = c;
  };
  const ConstStateView view = unit.view(slot);
  record_.time[at] = static_cast<double>(unit.step(slot)) * model->simulation.timestep;
  if (quantities_.body) {
    const std::size_t count = record_.particles, first = first_[instance];
    std::visit(
        [&](const auto& from) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(from)>, std::monostate>)
            for (std::size_t i = 0; i < count; ++i)
              for (std::size_t c = 0; c < 3; ++c)
                record_.positions[3 * (at * count + i) + c] = static_cast<float>(from.at(first + i, c));
        },
        view[0]);
  }
  const bool last = row + 1 == record_.times;
  if (!last && !quantities_.center_of_mass && !quantities_.momentum && !quantities_.energies &&
      !quantities_.actuator_work)
    return;
  State state;
  state.precision = Precision::single;
  state.step = unit.step(slot);
  resize(state, model->particle_count(), model->ball_count());
  const StateView to = view_of(state);
  for (std::size_t n = 0; n < view.size(); ++n) copy_vectors(view[n], to[n]);
  if (quantities_.center_of_mass) {
    const Vec3 center = center_of_mass(*model, state);
    put(record_.center_of_mass, center.x, center.y, center.z);
  }
  if (quantities_.momentum || quantities_.energies) {
    const Measures figures = quantities_.energies ? meters_[instance].measure(state, unit.inputs(slot))
                                                  : measure_motion(*model, state);
    if (quantities_.momentum)
      put(record_.momentum, figures.momentum.x, figures.momentum.y, figures.momentum.z);
    if (quantities_.energies) put(record_.energy, figures.kinetic, figures.elastic, figures.gravitational);
  }
  if (quantities_.actuator_work)
    record_.actuator_work[at] = works_[instance].add(*model, state, unit.inputs(slot)).value_or(0.0);
  if (!last) return;
  const auto divergence = unit.divergence(slot);
  record_.diverged[instance] = divergence ? divergence->step : 0;
  record_.hash[instance] = state_hash(state);
}

}  // namespace aspic::batch
