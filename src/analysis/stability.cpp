#include "analysis/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/amplification.h"
#include "analysis/spectrum.h"

namespace aspic {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Effort {
  double tolerance;  // of Lanczos' residual, relative
  int iterations;
  std::size_t dense_dof;
};
constexpr Effort quick = {1e-4, 100, 81};
constexpr Effort thorough = {1e-7, 1000, 600};

/// A body with what several integrators ask of it, computed once.
class BodyAnalysis {
 public:
  BodyAnalysis(LinearisedBody body, const Effort& effort) : body_(std::move(body)), effort_(effort) {}

  const LinearisedBody& body() const { return body_; }
  bool small() const { return body_.free_dof() <= effort_.dense_dof; }
  LargestEigenvalue largest(double stiffness_factor, double damping_factor) const {
    return body_.largest_eigenvalue(stiffness_factor, damping_factor, effort_.tolerance, effort_.iterations);
  }
  const LargestEigenvalue& kappa_max() {
    if (!kappa_) kappa_ = largest(1.0, 0.0);
    return *kappa_;
  }
  const LargestEigenvalue& gamma_max() {
    if (!gamma_) gamma_ = largest(0.0, 1.0);
    return *gamma_;
  }
  const std::vector<std::complex<double>>& eigenvalues() {
    if (!eigenvalues_) eigenvalues_ = body_.eigenvalues();
    return *eigenvalues_;
  }

 private:
  LinearisedBody body_;
  Effort effort_;
  std::optional<LargestEigenvalue> kappa_, gamma_;
  std::optional<std::vector<std::complex<double>>> eigenvalues_;
};

/// none (nothing) is smaller than any step.
StabilityLimit smaller(const StabilityLimit& a, const StabilityLimit& b) {
  if (!a.step || !b.step)
    return {std::nullopt, !a.step && !b.step ? a.exact || b.exact : (a.step ? b.exact : a.exact)};
  return *b.step < *a.step ? b : a;
}

StabilityLimit of_mode(Integrator integrator, double kappa, double gamma) {
  return {mode_limit(integrator, kappa, gamma), true};
}

/// Calls f(share) for shares of (0, 1]: logarithmically down to 1e-6, where every method's limit has long
/// left what the largest eigenvalue sets, and densely near 1.
template <class F>
void scan_unit_interval(int steps, const F& f) {
  for (int i = 0; i <= steps; ++i) f(std::pow(10.0, -6.0 * i / steps));
  for (int i = 1; i < steps; ++i) f(static_cast<double>(i) / steps);
}

StabilityLimit proportional_limit(BodyAnalysis& analysis, Integrator integrator) {
  const LinearisedBody& body = analysis.body();
  const bool by_damping = body.smallest_ratio() == infinity;  // k = 0 everywhere
  const LargestEigenvalue top = by_damping ? analysis.gamma_max() : analysis.kappa_max();
  const auto at = [&](double share) {
    const double value = share * top.value;
    return by_damping ? of_mode(integrator, 0.0, value)
                      : of_mode(integrator, value, body.smallest_ratio() * value);
  };
  const StabilityLimit end = at(1.0);
  StabilityLimit least = end;
  scan_unit_interval(300, [&](double share) { least = smaller(least, at(share)); });
  // The interval holds all eigenvalues, but not each of its points is one: only its upper end is sure to be.
  const bool at_end =
      end.step && least.step ? *end.step <= *least.step * (1.0 + 1e-9) : end.step == least.step;
  return {least.step, at_end && top.converged};
}

/// λ_max(h²K + 2hC) = 4: for larger h the step matrix has an eigenvalue below −1, for smaller h none outside
/// the unit circle (docs/physics.md).
StabilityLimit symplectic_limit(BodyAnalysis& analysis) {
  bool converged = true;
  const auto excess = [&](double h) {
    const LargestEigenvalue top = analysis.largest(h * h, 2.0 * h);
    converged = converged && top.converged;
    return top.value - 4.0;
  };
  const double kappa = analysis.kappa_max().value;
  const double gamma = analysis.gamma_max().value;
  double low =
      *mode_limit(Integrator::symplectic_euler, kappa, gamma);  // both extremes at once: never too large
  double high = std::min(*mode_limit(Integrator::symplectic_euler, kappa, 0.0),
                         *mode_limit(Integrator::symplectic_euler, 0.0, gamma));
  double f_low = excess(low), f_high = excess(high);
  for (int i = 0; i < 12 && high - low > 1e-7 * low && f_low < 0.0 && f_high > 0.0; ++i) {
    // The function is convex, so the secant never passes the root from below; the middle tames the upper end.
    const double secant = low - f_low * (high - low) / (f_high - f_low);
    const double f_secant = excess(secant);
    (f_secant > 0.0 ? high : low) = secant;
    (f_secant > 0.0 ? f_high : f_low) = f_secant;
    const double middle = low + std::min(0.5 * (high - low), 2.0 * std::abs(secant - low) + 1e-7 * low);
    const double f_middle = excess(middle);
    (f_middle > 0.0 ? high : low) = middle;
    (f_middle > 0.0 ? f_high : f_low) = f_middle;
  }
  return {low, converged};
}

StabilityLimit dense_limit(BodyAnalysis& analysis, Integrator integrator) {
  const std::vector<std::complex<double>>& eigenvalues = analysis.eigenvalues();
  double largest = 0.0;
  for (const auto& lambda : eigenvalues) largest = std::max(largest, std::abs(lambda));
  StabilityLimit limit = {infinity, true};
  for (const auto& lambda : eigenvalues) {
    // Rigid motions have λ = 0 twice, a defective pair that rounding spreads by about √ε of the largest.
    if (std::abs(lambda) < 1e-6 * largest) continue;
    // No mode gains energy: a positive real part of rounding's size is an undamped mode.
    const double real = lambda.real() > -1e-11 * largest ? 0.0 : lambda.real();
    limit = smaller(limit, {eigenvalue_limit(integrator, {real, lambda.imag()}), true});
  }
  return limit;
}

/// The minimum over every (κ, γ) with κ ≤ κ_max, γ ≤ γ_max and γ/κ between the springs' own ratios: for an
/// eigenvector u these are u*Ku and u*Cu, sums over springs whose terms each keep the spring's ratio.
StabilityLimit bounded_limit(BodyAnalysis& analysis, Integrator integrator) {
  const double kappa_max = analysis.kappa_max().value;
  const double gamma_max = analysis.gamma_max().value;
  const LinearisedBody& body = analysis.body();
  StabilityLimit least = {infinity, false};
  const auto visit = [&](double kappa) {
    const double from = std::min(body.smallest_ratio() * kappa, gamma_max);
    const double to = std::min(body.largest_ratio() * kappa, gamma_max);
    constexpr int steps = 40;
    for (int i = 0; i <= steps; ++i) {
      least = smaller(least, of_mode(integrator, kappa, from + (to - from) * i / steps));
    }
  };
  scan_unit_interval(60, [&](double share) { visit(share * kappa_max); });
  least = smaller(least, of_mode(integrator, 0.0, gamma_max));
  least.exact = false;
  return least;
}

StabilityLimit body_limit(BodyAnalysis& analysis, Integrator integrator) {
  const LinearisedBody& body = analysis.body();
  const IntegratorRow& row = row_of(integrator);
  if (row.solved() || !body.has_springs()) return {infinity, true};
  if (body.proportional()) return proportional_limit(analysis, integrator);
  if (row.drift == Drift::new_velocity) return symplectic_limit(analysis);
  if (analysis.small() && !row.mode_limit) return dense_limit(analysis, integrator);
  return bounded_limit(analysis, integrator);
}

/// Calls f for each body; particles outside any body count as one more.
template <class F>
void for_each_body(const Model& model, const F& f) {
  std::uint32_t covered = 0;
  for (const Body& body : model.bodies) covered += body.particle_count;
  if (covered != model.particle_count()) {
    f(LinearisedBody(model, 0, model.particle_count()));
    return;
  }
  for (const Body& body : model.bodies) f(LinearisedBody(model, body.first_particle, body.particle_count));
}

}  // namespace

std::vector<StabilityLimit> stability_limits(const Model& model, std::span<const Integrator> integrators,
                                             StabilityEffort effort) {
  std::vector<StabilityLimit> limits(integrators.size(), StabilityLimit{infinity, true});
  for_each_body(model, [&](LinearisedBody body) {
    BodyAnalysis analysis(std::move(body), effort == StabilityEffort::quick ? quick : thorough);
    for (std::size_t i = 0; i < integrators.size(); ++i) {
      limits[i] = smaller(limits[i], body_limit(analysis, integrators[i]));
    }
  });
  return limits;
}

bool certainly_stable(const Model& model, Integrator integrator, double timestep) {
  if (row_of(integrator).solved()) return true;
  std::uint32_t covered = 0;
  for (const Body& body : model.bodies) {
    covered += body.particle_count;
    double stiffness = 0.0, ratio = 0.0, inverse_mass = 0.0;
    for (std::uint32_t c = body.first_class; c < body.first_class + body.class_count; ++c) {
      const SpringClass& spring = model.spring_classes[c];
      if (spring.stiffness == 0.0) return false;
      if (stiffness != 0.0 && spring.damping / spring.stiffness != ratio) return false;
      ratio = spring.damping / spring.stiffness;
      stiffness = std::max(stiffness, spring.stiffness);
    }
    for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      inverse_mass = std::max(inverse_mass, model.inverse_mass[i]);
    }
    const double kappa = infinite_lattice_eigenvalue * stiffness * inverse_mass;
    StabilityLimit least = of_mode(integrator, kappa, ratio * kappa);
    scan_unit_interval(300, [&](double share) {
      least = smaller(least, of_mode(integrator, share * kappa, ratio * share * kappa));
    });
    if (body.kind != BodyKind::cube || !least.step || timestep > *least.step) return false;
  }
  return covered == model.particle_count();
}

StabilityLimit stability_limit(const Model& model, Integrator integrator, StabilityEffort effort) {
  if (row_of(integrator).solved()) return {infinity, true};
  return stability_limits(model, {&integrator, 1}, effort).front();
}

double largest_stiffness_eigenvalue(const Model& model) {
  double largest = 0.0;
  for_each_body(model, [&](const LinearisedBody& body) {
    largest =
        std::max(largest, body.largest_eigenvalue(1.0, 0.0, thorough.tolerance, thorough.iterations).value);
  });
  return largest;
}

}  // namespace aspic
