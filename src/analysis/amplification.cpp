#include "analysis/amplification.h"

#include <cassert>
#include <cmath>

namespace aspic {
namespace {

constexpr std::size_t max_degree = max_stages;

// Every method of the table loses stability well inside this |z|: a polynomial of degree 4 with R ≈ eᶻ cannot
// stay bounded further out. The furthest stable point along any ray: 2.83 (fourth-order Runge–Kutta on the
// imaginary axis) to 3.04 close to it.
constexpr double search_radius = 4.0;
constexpr int search_steps = 800;

/// Coefficients of |R(ρ·e^{iθ})|² − 1 as a polynomial in ρ.
std::array<double, 2 * max_degree + 1> growth_along_ray(const Staged& method, double angle) {
  const auto r = amplification_polynomial(method);
  std::array<double, 2 * max_degree + 1> growth = {};
  for (std::size_t n = 0; n < r.size(); ++n) {
    for (std::size_t m = 0; m < r.size(); ++m) {
      growth[n + m] += r[n] * r[m] * std::cos((static_cast<double>(n) - static_cast<double>(m)) * angle);
    }
  }
  growth[0] = 0.0;
  // On the imaginary axis terms cancel exactly in theory; what rounding leaves must not decide the sign near
  // zero.
  for (double& c : growth) {
    if (std::abs(c) < 1e-13) c = 0.0;
  }
  return growth;
}

}  // namespace

std::array<double, max_stages + 1> amplification_polynomial(const Staged& method) {
  std::array<double, max_degree + 1> stage = {1.0}, result = {1.0};
  for (const Stage& s : method.stages) {
    for (std::size_t i = 0; i < max_degree; ++i) result[i + 1] += s.weight / method.divisor * stage[i];
    std::array<double, max_degree + 1> next = {1.0};
    for (std::size_t i = 0; i < max_degree; ++i) next[i + 1] = s.advance * stage[i];
    stage = next;
  }
  return result;
}

std::optional<double> eigenvalue_limit(Integrator integrator, std::complex<double> lambda) {
  const Staged& method = *row_of(integrator).staged();
  assert(!method.mode_limit);
  const double size = std::abs(lambda);
  if (size == 0.0) return infinity;
  const auto growth = growth_along_ray(method, std::arg(lambda));
  std::size_t lowest = 1;
  while (lowest < growth.size() && growth[lowest] == 0.0) ++lowest;
  if (lowest == growth.size()) return infinity;
  if (growth[lowest] > 0.0) return std::nullopt;
  // Dividing by ρ^lowest leaves a polynomial that starts negative (stable); its first change of sign is the
  // limit.
  const auto value = [&](double rho) {
    double sum = 0.0;
    for (std::size_t i = growth.size(); i-- > lowest;) sum = sum * rho + growth[i];
    return sum;
  };
  double inside = 0.0, outside = search_radius;
  for (int i = 1; i <= search_steps; ++i) {
    const double rho = search_radius * i / search_steps;
    if (value(rho) > 0.0) {
      outside = rho;
      break;
    }
    inside = rho;
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (value(middle) > 0.0 ? outside : inside) = middle;
  }
  return inside / size;
}

std::optional<double> mode_limit(Integrator integrator, double kappa, double gamma) {
  assert(!(kappa < 0.0) && !(gamma < 0.0));
  const IntegratorRow& row = row_of(integrator);
  if (row.traits.stable_at_any_step || (kappa == 0.0 && gamma == 0.0)) return infinity;
  // The limit as either grows beyond all bounds; NaN is the quotient or product of such values.
  if (!std::isfinite(kappa) || !std::isfinite(gamma)) return 0.0;
  if (const ModeLimit limit = row.staged()->mode_limit) return limit(kappa, gamma);
  // 4κ/γ² decides between real and complex roots; written with √ so that large κ and γ do not overflow.
  const double root_kappa = std::sqrt(kappa);
  if (gamma < 2.0 * root_kappa) {
    const double imaginary = std::sqrt((root_kappa - 0.5 * gamma) * (root_kappa + 0.5 * gamma));
    return eigenvalue_limit(integrator, {-0.5 * gamma, imaginary});
  }
  // Both roots are real: the fast one, further out on the same ray, decides.
  const double fast = 0.5 * (gamma + std::sqrt((gamma - 2.0 * root_kappa) * (gamma + 2.0 * root_kappa)));
  return eigenvalue_limit(integrator, {-fast, 0.0});
}

}  // namespace aspic
