// Both sides of every explicit method's stability edge, on the default cube.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/stability.h"
#include "verify/experiments.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

/// Steps on each side, and in each of the two windows at the ends over which the amplitude is taken: longer
/// than half a period of the slowest oscillation met here.
constexpr std::uint64_t steps = 1000, window = 80;

/// The default cube without gravity, free.
Result<Model> free_cube(Integrator integrator, double damping) {
  ModelSettings settings = cube_settings(10);
  settings.simulation.integrator = integrator;
  settings.simulation.gravity = {0, 0, 0};
  CubeSettings& cube = settings.cubes[0];
  cube.structural = cube.shear = cube.bending = {2000.0, damping};
  return build_model(settings);
}

/// Power iteration needs few enough rounds: an eigenvalue 1e-4 too low moves a limit by as much, and the edge
/// is probed at distances of 1e-3 and 5e-3.
WorstMode worst_mode(const Model& model) {
  return power_iteration(model, 1500);
}

/// Final amplitude over first, of a motion that starts in the mode so small (1e-9 m) that the springs are
/// linear to nine digits. Infinite after divergence.
Result<double> growth(const Subject& subject, const Model& model, const WorstMode& mode) {
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
  const State rest = initial_state(model, Precision::double_);
  State state = rest;
  const double scale = 1e-9 / mode.shape.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      state.position[i][axis] += scale * mode.shape[static_cast<Eigen::Index>(3 * i) + axis];
    }
  }
  ASPIC_CHECK(solver->load(state));
  double first = 0.0, last = 0.0;
  for (std::uint64_t step = 0; step < steps; ++step) {
    const bool early = step < window, late = step >= steps - window;
    if (early || late) {
      ASPIC_TRY(auto now, solver->state());
      double square = 0.0;
      for (std::size_t i = 0; i < now.position.size(); ++i) {
        const Vec3 d = now.position[i] - rest.position[i];
        square += dot(d, d);
      }
      (early ? first : last) = std::max(early ? first : last, std::sqrt(square));
    }
    const std::uint64_t stride = early || late ? 1 : steps - window - step;
    ASPIC_TRY(const auto advanced, solver->advance(stride));
    if (advanced.divergence) return std::numeric_limits<double>::infinity();
    step += stride - 1;
  }
  return last / first;
}

Result<Finding> edge(const Subject& subject, Integrator integrator, double damping) {
  ASPIC_TRY(auto model, free_cube(integrator, damping));
  const WorstMode mode = worst_mode(model);
  const StabilityLimit limit = stability_limit(model, integrator);
  if (!limit.step) return Error{ErrorCode::check_failed, "no stable step was found"};
  model.simulation.timestep = 0.999 * *limit.step;
  ASPIC_TRY(auto below, growth(subject, model, mode));
  model.simulation.timestep = 1.005 * *limit.step;
  ASPIC_TRY(auto above, growth(subject, model, mode));
  return Finding{below <= 1.0 && above >= 2.0,
                 fmt::format("×{:.3g} below, ×{:.3g} above {:.6f} s", below, above, *limit.step)};
}

Result<Finding> largest_eigenvalue(const Subject&) {
  ASPIC_TRY(auto model, free_cube(Integrator::explicit_euler, 60.0));
  const double power = power_iteration(model, 8000).kappa / 2000.0,
               lanczos = largest_stiffness_eigenvalue(model) / 2000.0;
  return Finding{std::abs(power - 16.850) <= 5e-4 && std::abs(lanczos - 16.850) <= 5e-4,
                 fmt::format("{:.5f} by power iteration, {:.5f} by Lanczos", power, lanczos)};
}

}  // namespace

void add_stability_checks(std::vector<Check>& checks) {
  checks.push_back({"stability/eigenvalue", "largest operator eigenvalue α of the default 10³ cube",
                    "16.850 to its five digits", true, false, largest_eigenvalue});
  // α c²/(4 k m) is 7.6 with c = 60 (real eigenvalues) and 0.21 with c = 10 (complex pairs).
  for (const auto& [kind, damping] : {std::pair{"real", 60.0}, std::pair{"complex", 10.0}}) {
    for (const Integrator integrator : explicit_integrators) {
      checks.push_back(
          {fmt::format("stability/{}/{}", kind, name_of(integrator)),
           fmt::format(
               "default cube, c = {}: the worst mode does not grow at 0.999 of the limit and does at 1.005",
               damping),
           fmt::format("≤ ×1 below, ≥ ×2 above in {} steps", steps), integrator == Integrator::explicit_euler,
           false, [=, c = damping](const Subject& subject) { return edge(subject, integrator, c); }});
    }
  }
}

}  // namespace aspic::verify
