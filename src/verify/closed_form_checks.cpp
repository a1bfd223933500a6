// One spring against powers of each integrator's amplification matrix.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

using Real = long double;

/// Row by row, on (q, q̇), q = L − r.
StepMatrix operator*(const StepMatrix& m, const StepMatrix& n) {
  return {m[0] * n[0] + m[1] * n[2], m[0] * n[1] + m[1] * n[3], m[2] * n[0] + m[3] * n[2],
          m[2] * n[1] + m[3] * n[3]};
}

/// By repeated squaring, so that it has nothing in common with stepping.
StepMatrix power(StepMatrix base, std::uint64_t exponent) {
  StepMatrix result = {1, 0, 0, 1};
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = result * base;
    base = base * base;
  }
  return result;
}

constexpr double stiffness = 50.0, rest_length = 1.0, stretch = 0.01, bound = 1e-12;

Result<Finding> follows_matrix(const Subject& subject, Integrator integrator, double damping) {
  const double half = (rest_length + stretch) / 2;
  Model model = loose_particles({{half, 0, 0}, {-half, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  model.simulation.gravity = {0, 0, 0};
  model.simulation.integrator = integrator;
  model.simulation.implicit = {50, 500, 1e-16};
  model.spring_classes.push_back({SpringType::structural, stiffness, damping, rest_length, false});
  model.listed_springs.push_back({0, 1, 0});
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));

  // Equal masses m on a spring: the distance obeys q̈ = −(2/m)(kq + cq̇).
  const StepMatrix step = row_of(integrator)
                              .step_matrix(static_cast<Real>(model.simulation.timestep), 2 * stiffness,
                                           2 * static_cast<Real>(damping));
  const Real q0 = static_cast<Real>(half + half) - rest_length;
  double worst = 0.0;
  for (std::uint64_t n = 100; n <= 10000; n += 100) {
    ASPIC_TRY(auto now, run(*solver, 100));
    const StepMatrix m = power(step, n);
    const Real q = static_cast<Real>(now.position[0].x) - static_cast<Real>(now.position[1].x) - rest_length;
    const Real rate = static_cast<Real>(now.velocity[0].x) - static_cast<Real>(now.velocity[1].x);
    // As lengths: the rate over the frequency √κ.
    const Real frequency = std::sqrt(Real(2) * stiffness);
    const double error =
        static_cast<double>(std::max(std::abs(q - m[0] * q0), std::abs(rate - m[2] * q0) / frequency));
    worst = error > worst || std::isnan(error) ? error : worst;
  }
  return at_most(worst, bound, "m");
}

}  // namespace

void add_closed_form_checks(std::vector<Check>& checks) {
  constexpr std::array<std::pair<const char*, double>, 2> kinds = {{{"undamped", 0.0}, {"damped", 0.5}}};
  for (const auto& [kind, damping] : kinds) {
    for (const Integrator integrator : all_integrators) {
      checks.push_back(
          {fmt::format("closed-form/{}/{}", kind, name_of(integrator)),
           fmt::format("one {} spring follows powers of the amplification matrix for 10,000 steps", kind),
           at_most_text(bound, "m"), true, false,
           [=, c = damping](const Subject& subject) { return follows_matrix(subject, integrator, c); }});
    }
  }
}

}  // namespace aspic::verify
