#include "analysis/stability_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/spectrum.h"
#include "base/split_mix.h"
#include "model/integrator.h"
#include "model/springs.h"

namespace aspic {
namespace {

constexpr double strain = 1e-3;  ///< of a probe's start: springs are linear to three digits
constexpr double noise = 0.1;    ///< of it
constexpr double ended = 30.0;   ///< times the start: it grows beyond doubt
constexpr double margin = 1.02;  ///< growth above rounding's
/// Share of the start below which nothing counts as growth: a damped motion ends in the noise of rounding,
/// which large steps multiply.
constexpr double least_growth = 0.05, least_growth_of_large_steps = 0.5;

/// Root of the mean square of all displacements [m].
double amplitude(const State& state, const State& rest) {
  double sum = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const Vec3 d = state.position[i] - rest.position[i];
    sum += dot(d, d);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, state.position.size())));
}

}  // namespace

Model alone_in_space(Model model) {
  model.simulation.gravity = {};
  model.terrain.clear();
  model.balls.clear();
  for (SpringClass& spring : model.spring_classes) spring.cord = false;
  // In steps of the usual residual a motion as small as a probe's would wander.
  model.simulation.implicit.tolerance = 2e-6;
  return model;
}

Model with_constants(Model model, double stiffness_factor, double damping_factor, double timestep) {
  for (SpringClass& spring : model.spring_classes) {
    spring.stiffness *= stiffness_factor;
    spring.damping *= damping_factor;
  }
  model.simulation.timestep = timestep;
  return model;
}

ProbeStart probe_start(const Model& model) {
  ProbeStart start;
  start.rest = initial_state(model, Precision::single);
  for (Vec3& v : start.rest.velocity) v = {};
  if (model.bodies.empty()) {
    start.displaced = start.rest;
    return start;
  }
  const Body& body = model.bodies.front();
  Vec3 center;
  for (std::uint32_t i = 0; i < body.particle_count; ++i)
    center = center + start.rest.position[body.first_particle + i];
  center = center / static_cast<double>(body.particle_count);
  for (Vec3& x : start.rest.position) x = x - center;

  double shortest = std::numeric_limits<double>::infinity();
  for (std::uint32_t c = body.first_class; c < body.first_class + body.class_count; ++c)
    shortest = std::min(shortest, model.spring_classes[c].rest_length);
  const double size = strain * (std::isfinite(shortest) ? shortest : 1.0);
  const LinearizedBody linear(model, body.first_particle, body.particle_count);
  constexpr int rounds = 300;
  const std::vector<Vec3> stiff = linear.stiffest_mode(1.0, 0.0, rounds);
  const std::vector<Vec3> damped =
      linear.proportional() ? std::vector<Vec3>(stiff.size()) : linear.stiffest_mode(0.0, 1.0, rounds);
  start.displaced = start.rest;
  SplitMix64 random(1);
  const auto scatter = [&] { return noise * (2.0 * random.share() - 1.0); };
  for (std::uint32_t i = 0; i < body.particle_count; ++i) {
    const std::uint32_t particle = body.first_particle + i;
    if (model.inverse_mass[particle] == 0.0) continue;
    const double x = scatter(), y = scatter(), z = scatter();
    Vec3& at = start.displaced.position[particle];
    at = at + size * (stiff[i] + damped[i] + Vec3{x, y, z});
  }
  return start;
}

Result<bool> grows(Solver& solver, const ProbeStart& start, std::uint64_t steps) {
  ASPIC_CHECK(solver.load(start.displaced));
  const double first_amplitude = amplitude(start.displaced, start.rest);
  double early = 0.0, late = 0.0;
  // After three steps and five in turn, so that oscillations of any period show.
  for (std::uint64_t step = 0, look = 0; step < steps; ++look) {
    const std::uint64_t count = std::min<std::uint64_t>(3 + 2 * (look % 2), steps - step);
    ASPIC_TRY(const auto advanced, solver.advance(count));
    if (advanced.divergence) return true;
    step += count;
    ASPIC_TRY(const auto state, solver.state());
    const double now = amplitude(state, start.rest);
    if (!(now <= ended * first_amplitude)) return true;
    if (3 * step <= steps) early = std::max(early, now);
    if (3 * step >= 2 * steps) late = std::max(late, now);
  }
  const bool any_step = row_of(solver.model().simulation.integrator).traits.stable_at_any_step;
  const double least = any_step ? least_growth_of_large_steps : least_growth;
  return late > margin * early && late > least * first_amplitude;
}

Result<double> measured_limit(const Model& model, const ProbeStart& start, const MakeSolver& make, double low,
                              double high, double tolerance, std::uint64_t steps) {
  const auto grows_at = [&](double h) -> Result<bool> {
    const Model probed = with_constants(model, 1.0, 1.0, h);
    ASPIC_TRY(const auto solver, make(probed));
    return grows(*solver, start, steps);
  };
  ASPIC_TRY(const bool at_low, grows_at(low));
  if (at_low) return low;
  ASPIC_TRY(const bool at_high, grows_at(high));
  if (!at_high) return high;
  while (high > low * (1.0 + tolerance)) {
    const double middle = std::sqrt(low * high);
    ASPIC_TRY(const bool at_middle, grows_at(middle));
    (at_middle ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace aspic
