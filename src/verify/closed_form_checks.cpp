// One spring against powers of each integrator's amplification matrix.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "verify/experiments.h"

namespace aspic::verify {
namespace {

using Real = long double;

/// A 2×2 matrix acting on (q, q̇), q = L − r.
struct Matrix {
  Real a = 1, b = 0, c = 0, d = 1;

  friend Matrix operator*(const Matrix& m, const Matrix& n) {
    return {m.a * n.a + m.b * n.c, m.a * n.b + m.b * n.d, m.c * n.a + m.d * n.c, m.c * n.b + m.d * n.d};
  }
  friend Matrix operator+(const Matrix& m, const Matrix& n) {
    return {m.a + n.a, m.b + n.b, m.c + n.c, m.d + n.d};
  }
  friend Matrix operator*(Real s, const Matrix& m) { return {s * m.a, s * m.b, s * m.c, s * m.d}; }
};

/// One step of q̈ = −κq − γq̇ (docs/physics.md, "Amplification").
Matrix amplification(Integrator integrator, Real h, Real kappa, Real gamma) {
  const Matrix one, z = {0, h, -h * kappa, -h * gamma}, z2 = z * z;
  switch (integrator) {
    case Integrator::explicit_euler:
      return one + z;
    case Integrator::symplectic_euler:
      return Matrix{1, h, 0, 1} * Matrix{1, 0, -h * kappa, 1 - h * gamma};
    case Integrator::midpoint:
      return one + z + Real(0.5) * z2;
    case Integrator::runge_kutta_4:
      return one + z + Real(0.5) * z2 + Real(1) / 6 * (z2 * z) + Real(1) / 24 * (z2 * z2);
    case Integrator::implicit_euler_one_pass:
      return one + z + z2;
    case Integrator::implicit_euler:
      break;
  }
  const Real determinant = 1 + h * gamma + h * h * kappa;
  return 1 / determinant * Matrix{1 + h * gamma, h, -h * kappa, 1};
}

/// By repeated squaring, so that it has nothing in common with stepping.
Matrix power(Matrix base, std::uint64_t exponent) {
  Matrix result;
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
  model.springs.push_back({0, 1, 0});
  ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));

  // Equal masses m on a spring: the distance obeys q̈ = −(2/m)(kq + cq̇).
  const Matrix step = amplification(integrator, static_cast<Real>(model.simulation.timestep), 2 * stiffness,
                                    2 * static_cast<Real>(damping));
  const Real q0 = static_cast<Real>(half + half) - rest_length;
  double worst = 0.0;
  for (std::uint64_t n = 100; n <= 10000; n += 100) {
    ASPIC_TRY(auto now, run(*solver, 100));
    const Matrix m = power(step, n);
    const Real q = static_cast<Real>(now.position[0].x) - static_cast<Real>(now.position[1].x) - rest_length;
    const Real rate = static_cast<Real>(now.velocity[0].x) - static_cast<Real>(now.velocity[1].x);
    // As lengths: the rate over the frequency √κ.
    const Real frequency = std::sqrt(Real(2) * stiffness);
    const double error =
        static_cast<double>(std::max(std::abs(q - m.a * q0), std::abs(rate - m.c * q0) / frequency));
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
