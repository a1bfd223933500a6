// Fast arithmetic: its distance from double precision, compared with that of exact single precision.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/springs.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

/// Unit roundoff of single precision.
constexpr double u = epsilon_single / 2;

/// Springs at a particle of a cube, at most.
constexpr int most_springs = 32;

/// Roundings between a step's start and the velocity at its end, each at most u of the scale in scales():
/// of a spring, 28 (its constants 3; e and v 2; their products 6; twice the reciprocal root, whose argument
/// has 5, half of which count, its Newton step 3.4 and the operations of that 3; 4 to put it together), an
/// addition for each spring, and 6 from the force to the velocity.
constexpr int roundings = 28 + most_springs + 6;

/// A cube and a net of cords: both ways in which a solver finds springs. Nothing falls, since the rounding of
/// a common velocity would cover what springs contribute.
ModelSettings cube_and_net(Integrator integrator) {
  ModelSettings settings = cube_settings(6);
  settings.goal_nets.emplace_back().cord = true;
  settings.goal_nets.front().position = {9.0, 4.0, 0.0};
  settings.simulation.integrator = integrator;
  settings.simulation.gravity = {0.0, 0.0, 0.0};
  settings.simulation.timestep = 5e-4;  // every method is stable
  return settings;
}

/// A start that is the same in single and double precision.
Result<State> common_start(const Subject& subject, const Model& model) {
  ASPIC_TRY(auto solver, subject.reference(model, Precision::single));
  ASPIC_CHECK(solver->load(shaken(model, 0.03, 2.0, 11)));
  return solver->state();
}

/// For each particle [m/s]: h/m·(m|g| + Σ (k(L + r) + c|v|)) + |v|, the largest numbers that its new velocity
/// is made of.
std::vector<double> scales(const Model& model, const State& at) {
  std::vector<double> scale(model.particle_count());
  for (std::size_t i = 0; i < scale.size(); ++i)
    scale[i] = length(at.velocity[i]) / model.simulation.timestep + length(model.simulation.gravity);
  for (const Spring& s : springs_of(model)) {
    const SpringClass& of = model.spring_classes[s.spring_class];
    const double most = of.stiffness * (length(at.position[s.a] - at.position[s.b]) + of.rest_length) +
                        of.damping * length(at.velocity[s.a] - at.velocity[s.b]);
    scale[s.a] += most * model.inverse_mass[s.a];
    scale[s.b] += most * model.inverse_mass[s.b];
  }
  for (double& of : scale) of *= model.simulation.timestep;
  return scale;
}

/// Largest error of the velocity after a step, in roundings of its scale.
Result<double> step_error(Solver& solver, const State& start, const State& expected) {
  ASPIC_TRY(const auto end, run(solver, 1, &start));
  const std::vector<double> scale = scales(solver.model(), start);
  double worst = 0.0;
  for (std::size_t i = 0; i < scale.size(); ++i)
    worst = std::max(worst, length(end.velocity[i] - expected.velocity[i]) / (u * scale[i]));
  return worst;
}

Result<Finding> one_step(const Subject& subject, const BackendRow& row) {
  ASPIC_TRY(const auto model, build_model(cube_and_net(Integrator::explicit_euler)));
  ASPIC_TRY(const auto start, common_start(subject, model));
  ASPIC_TRY(const auto expected, run_reference(subject, model, Precision::double_, 1, &start));
  ASPIC_TRY(auto fast, subject.other(model, {.row = &row, .arithmetic = Arithmetic::fast}));
  ASPIC_TRY(auto exact, subject.reference(model, Precision::single));
  ASPIC_TRY(const double of_fast, step_error(*fast, start, expected));
  ASPIC_TRY(const double of_exact, step_error(*exact, start, expected));
  return Finding{of_fast <= roundings, fmt::format("{:.2g}; exact {:.2g}", of_fast, of_exact)};
}

/// Root of the mean square distance of positions [m].
double distance(const State& a, const State& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i)
    sum += dot(a.position[i] - b.position[i], a.position[i] - b.position[i]);
  return std::sqrt(sum / static_cast<double>(a.position.size()));
}

Result<Finding> one_second(const Subject& subject, const BackendRow& row, Integrator integrator) {
  ASPIC_TRY(const auto model, build_model(cube_and_net(integrator)));
  ASPIC_TRY(const auto start, common_start(subject, model));
  const std::uint64_t steps = steps_of(model, 1.0);
  ASPIC_TRY(const auto expected, run_reference(subject, model, Precision::double_, steps, &start));
  ASPIC_TRY(const auto exact, run_reference(subject, model, Precision::single, steps, &start));
  ASPIC_TRY(auto solver, subject.other(model, {.row = &row, .arithmetic = Arithmetic::fast}));
  ASPIC_TRY(const auto fast, run(*solver, steps, &start));
  // The two differ in roundings of spring forces alone, and exact arithmetic in those of the method too.
  const double of_exact = distance(exact, expected), apart = distance(fast, exact);
  return Finding{apart <= of_exact, fmt::format("{:.2g} m; from double exact {:.2g} m, fast {:.2g} m", apart,
                                                of_exact, distance(fast, expected))};
}

}  // namespace

void add_fast_checks(std::vector<Check>& checks) {
  for (const BackendRow& row : backends()) {
    if (!row.fast) continue;
    checks.push_back(
        {fmt::format("fast/step/{}", row.name),
         "fast arithmetic against double precision after a step: velocity, in roundings (6e-8) of "
         "h/m·(m|g| + Σ k(L + r) + c|v|) + |v|",
         at_most_text(roundings), true, row.needs_context,
         [&row](const Subject& subject) { return one_step(subject, row); }});
    for (const Integrator integrator : explicit_integrators) {
      checks.push_back(
          {fmt::format("fast/second/{}/{}", name_of(integrator), row.name),
           "fast against exact arithmetic after 1 s, root mean square of positions: no farther apart than "
           "exact arithmetic in single precision is from double precision",
           "≤ exact from double", integrator == Integrator::explicit_euler, row.needs_context,
           [&row, integrator](const Subject& subject) { return one_second(subject, row, integrator); }});
    }
  }
}

}  // namespace aspic::verify
