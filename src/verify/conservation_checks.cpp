// Momentum and angular momentum of a free spinning cube.
#include <fmt/format.h>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr std::uint64_t steps = 20000;

struct Totals {
  Vec3 momentum, angular;  ///< [N·s], [N·m·s] about the center of mass
  double speed = 0.0;      ///< Σ m|v| [N·s]
};

Totals totals(const Model& model, const State& state) {
  Totals t;
  Vec3 center;
  double mass = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    mass += model.mass[i];
    center = center + model.mass[i] * state.position[i];
    t.momentum = t.momentum + model.mass[i] * state.velocity[i];
    t.speed += model.mass[i] * length(state.velocity[i]);
  }
  center = center / mass;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    t.angular = t.angular + model.mass[i] * cross(state.position[i] - center, state.velocity[i]);
  }
  return t;
}

struct Drift {
  double momentum = 0.0, angular = 0.0;
};

Result<Drift> drift(const Subject& subject, Integrator integrator, Precision precision) {
  ModelSettings settings = cube_settings(4, {0.0, 0.0, 0.0});
  settings.simulation.gravity = {0, 0, 0};
  settings.simulation.integrator = integrator;
  if (row_of(integrator).kind() == MethodKind::newton) {
    // Iterations leave momentum where the residual is; with nothing left of it but rounding the claim is the
    // method's.
    settings.simulation.implicit.tolerance = precision == Precision::single ? 1e-6 : 1e-15;
  }
  ASPIC_TRY(auto model, build_model(settings));
  State start = initial_state(model, precision);
  const Vec3 omega = {0.6, 1.0, -0.4};
  for (std::size_t i = 0; i < start.position.size(); ++i) start.velocity[i] = cross(omega, start.position[i]);
  ASPIC_TRY(auto solver, subject.reference(model, precision));
  ASPIC_TRY(auto first, run(*solver, 0, &start));
  ASPIC_TRY(auto last, run(*solver, steps));
  const Totals before = totals(model, first), after = totals(model, last);
  return Drift{length(after.momentum - before.momentum) / before.speed,
               length(after.angular - before.angular) / length(before.angular)};
}

}  // namespace

void add_conservation_checks(std::vector<Check>& checks) {
  for (const Precision precision : {Precision::double_, Precision::single}) {
    const bool exact = precision == Precision::double_;
    const double momentum_bound = exact ? 1e-13 : 1e-6, angular_bound = exact ? 1e-11 : 5e-5;
    for (const Integrator integrator : all_integrators) {
      const MethodTraits& traits = row_of(integrator).traits;
      const bool bounded = traits.keeps_angular_momentum;
      checks.push_back(
          {fmt::format("conservation/{}/{}", name_of(precision), name_of(integrator)),
           "free spinning 4³ cube, 20,000 steps: |ΔP|/Σm|v| and |ΔL|/|L| about the center of mass",
           fmt::format("P {}, L {}", at_most_text(momentum_bound),
                       bounded ? at_most_text(angular_bound) : "no bound"),
           !traits.long_steps && !exact, false, [=](const Subject& subject) -> Result<Finding> {
             ASPIC_TRY(auto d, drift(subject, integrator, precision));
             const bool kept = !bounded || d.angular <= angular_bound;
             return Finding{d.momentum <= momentum_bound && kept,
                            fmt::format("P {:.3g}, L {:.3g}", d.momentum, d.angular)};
           }});
    }
  }
}

}  // namespace aspic::verify
