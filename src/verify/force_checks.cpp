// The spring force against its energy and its symmetries.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/springs.h"
#include "verify/experiments.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

// One step of explicit Euler is v' = v + h·f/m: the force as the solver computes it, for any solver. h = 2⁻¹⁰
// divides without rounding and keeps speeds below divergence.
constexpr double probe_step = 0x1p-10;

Result<Model> probe_model(int particles_per_edge, const RotationSettings& rotation = {}) {
  ModelSettings settings = cube_settings(particles_per_edge, {0.0, 0.0, 0.0});
  settings.cubes[0].rotation = rotation;
  settings.simulation.gravity = {0, 0, 0};
  settings.simulation.timestep = probe_step;
  return build_model(settings);
}

Result<std::vector<Vec3>> forces(const Subject& subject, const Model& model, const State& state) {
  ASPIC_TRY(auto next, run_reference(subject, model, Precision::double_, 1, &state));
  std::vector<Vec3> f;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    f.push_back((model.mass[i] / probe_step) * (next.velocity[i] - state.velocity[i]));
  }
  return f;
}

double largest_component(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Result<Finding> gradient(const Subject& subject) {
  ASPIC_TRY(auto model, probe_model(4));
  State state = shaken(model, 0.1, 0.0, 3);
  ASPIC_TRY(auto f, forces(subject, model, state));
  constexpr double delta = 1e-5;
  double worst = 0.0;  // of error over bound
  double worst_error = 0.0;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    // The third derivative of ½k(L − r)² along any line is at most 3k(r/L)/L; central differences leave δ²/6
    // of it and ε·E/δ of rounding (the energy is summed in extended precision and rounded once).
    double third = 0.0;
    for (const Spring& spring : springs_of(model)) {
      if (spring.a != i && spring.b != i) continue;
      const SpringClass& s = model.spring_classes[spring.spring_class];
      const double L = length(state.position[spring.a] - state.position[spring.b]) - 2 * delta;
      third += 3 * s.stiffness * s.rest_length / (L * L);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double x = state.position[i][axis];
      state.position[i][axis] = x + delta;
      const double up = state.position[i][axis] - x, above = elastic_energy(model, state, i);
      state.position[i][axis] = x - delta;
      const double down = x - state.position[i][axis], below = elastic_energy(model, state, i);
      state.position[i][axis] = x;
      const double slope = (above - below) / (up + down);
      const double bound = delta * delta / 6 * third + 2 * epsilon_double * above / delta;
      const double error = std::abs(f[i][axis] + slope);
      worst = std::max(worst, error / bound);
      worst_error = std::max(worst_error, error);
    }
  }
  return Finding{worst <= 1.0,
                 fmt::format("{:.3g} of the bound (largest error {:.2g} N)", worst, worst_error)};
}

Result<Finding> invariance(const Subject& subject) {
  ASPIC_TRY(auto model, probe_model(4));
  const State state = shaken(model, 0.1, 1.0, 5);
  ASPIC_TRY(auto f, forces(subject, model, state));
  const Vec3 axis = {0.3, -1.0, 0.7}, shift = {11.0, -7.0, 5.0};
  constexpr double angle = 71.0;
  State moved = state;
  double largest = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    moved.position[i] = rotated(state.position[i], axis, angle) + shift;
    moved.velocity[i] = rotated(state.velocity[i], axis, angle);
    largest = std::max(largest, length(moved.position[i]));
  }
  ASPIC_TRY(auto g, forces(subject, model, moved));
  // Moving rounds each coordinate by about 4ε of the largest (rotation, translation), so a spring's vector by
  // η = 8√3·εX and its force by (k + 2|s|/L + 4c|Δv|/L)·η; the probe rounds v' by ε|v'| and divides by h.
  const double eta = 8 * std::sqrt(3.0) * epsilon_double * largest;
  std::vector<double> bound(f.size());
  for (std::size_t i = 0; i < f.size(); ++i) {
    bound[i] = 4 * epsilon_double * (length(state.velocity[i]) / probe_step + length(f[i]));
  }
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& s = model.spring_classes[spring.spring_class];
    const double L = length(state.position[spring.a] - state.position[spring.b]);
    const double rate = length(state.velocity[spring.a] - state.velocity[spring.b]);
    const double tension = s.stiffness * std::abs(L - s.rest_length) + s.damping * rate;
    const double share = (s.stiffness + 2 * tension / L + 4 * s.damping * rate / L) * eta;
    bound[spring.a] += share;
    bound[spring.b] += share;
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    worst = std::max(worst, largest_component(g[i] - rotated(f[i], axis, angle)) / bound[i]);
  }
  return Finding{worst <= 1.0, fmt::format("{:.3g} of the bound", worst)};
}

/// An undeformed cube is at rest whatever its attitude: each spring's rest length is the distance of its
/// ends.
Result<Finding> undeformed(const Subject& subject) {
  ASPIC_TRY(auto model, probe_model(5, {{1.0, 0.3, 0.7}, 25.0}));
  ASPIC_TRY(auto f, forces(subject, model, initial_state(model, Precision::double_)));
  double worst = 0.0;
  for (const Vec3& force_on_particle : f) worst = std::max(worst, length(force_on_particle));
  // At most 32 springs of k = 2,000 N/m, each vector rounded by 4√3·ε of coordinates up to √3·2 m.
  return at_most(worst, 32 * 2000.0 * 4 * 6 * epsilon_double, "N");
}

Result<Finding> falls(const Subject& subject) {
  constexpr int steps = 1000;
  double worst = 0.0;
  for (const Integrator integrator : all_integrators) {
    Model model = loose_particles({{0, 0, 0}}, {{0, 0, 0}}, 0.37);
    model.simulation.integrator = integrator;
    model.simulation.implicit.tolerance = 1e-15;
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps));
    worst = std::max(worst, std::abs(end.velocity[0].y / (-9.8 * steps * model.simulation.timestep) - 1));
  }
  // Each step rounds its increment (three operations) and its sum.
  return at_most(worst, 4 * steps * epsilon_double);
}

/// A free particle under drag alone, against v·exp(−γt). Each method's error is h^p of its order p.
Result<Finding> drags(const Subject& subject) {
  constexpr int steps = 1000;
  constexpr double drag = 2.0;
  double worst = 0.0;  // of error over bound
  for (const Integrator integrator : all_integrators) {
    Model model = loose_particles({{0, 0, 0}}, {{3, -1, 2}}, 0.37);
    model.simulation.gravity = {0, 0, 0};
    model.simulation.drag = drag;
    model.simulation.integrator = integrator;
    model.simulation.implicit.tolerance = 1e-15;
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, steps));
    const double h = model.simulation.timestep, decay = drag * h * steps;
    const double error = std::abs(end.velocity[0].x / (3 * std::exp(-decay)) - 1);
    const double bound = decay * std::pow(drag * h, row_of(integrator).order) + 8 * steps * epsilon_double;
    worst = std::max(worst, error / bound);
  }
  return Finding{worst <= 1.0, fmt::format("{:.3g} of the bound", worst)};
}

}  // namespace

void add_force_checks(std::vector<Check>& checks) {
  checks.push_back({"force/undeformed", "an undeformed, turned 5³ cube feels no force",
                    at_most_text(32 * 2000.0 * 4 * 6 * epsilon_double, "N"), true, false, undeformed});
  checks.push_back({"force/gravity", "0.37 kg fall as any mass does: v = g·t, every integrator",
                    at_most_text(4000 * epsilon_double), true, false, falls});
  checks.push_back({"force/drag", "drag γ slows a particle as v·exp(−γt), every integrator",
                    "γt·(γh)^p + 8nε of order p", true, false, drags});
  checks.push_back({"force/gradient",
                    "the force is minus the gradient of the elastic energy (shaken 4³ cube)",
                    "δ²/6·Σ3kr/L² + 2εE/δ, δ = 1e-5 m", true, false, gradient});
  checks.push_back({"force/invariance", "rotating and moving the body rotates the force (shaken 4³ cube)",
                    "Σ(k + 2|s|/L + 4c|Δv|/L)·8√3·εX", true, false, invariance});
}

}  // namespace aspic::verify
