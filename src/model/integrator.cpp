#include "model/integrator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace aspic {
namespace integrator_rows {
namespace {

StepMatrix operator*(const StepMatrix& m, const StepMatrix& n) {
  return {m[0] * n[0] + m[1] * n[2], m[0] * n[1] + m[1] * n[3], m[2] * n[0] + m[3] * n[2],
          m[2] * n[1] + m[3] * n[3]};
}
StepMatrix operator+(const StepMatrix& m, const StepMatrix& n) {
  return {m[0] + n[0], m[1] + n[1], m[2] + n[2], m[3] + n[3]};
}
StepMatrix operator*(long double s, const StepMatrix& m) {
  return {s * m[0], s * m[1], s * m[2], s * m[3]};
}

constexpr StepMatrix one = {1, 0, 0, 1};

/// Z = h·A of ẏ = A·y, y = (q, q̇).
StepMatrix scaled(long double h, long double kappa, long double gamma) {
  return {0, h, -h * kappa, -h * gamma};
}

}  // namespace

template <int order>
StepMatrix exponential(long double h, long double kappa, long double gamma) {
  const StepMatrix z = scaled(h, kappa, gamma);
  StepMatrix sum = one, term = one;
  for (int n = 1; n <= order; ++n) {
    term = 1.0L / static_cast<long double>(n) * (term * z);
    sum = sum + term;
  }
  return sum;
}
template StepMatrix exponential<1>(long double, long double, long double);
template StepMatrix exponential<2>(long double, long double, long double);
template StepMatrix exponential<3>(long double, long double, long double);
template StepMatrix exponential<4>(long double, long double, long double);

StepMatrix symplectic_euler(long double h, long double kappa, long double gamma) {
  return StepMatrix{1, h, 0, 1} * StepMatrix{1, 0, -h * kappa, 1 - h * gamma};
}

StepMatrix implicit_euler_one_pass(long double h, long double kappa, long double gamma) {
  const StepMatrix z = scaled(h, kappa, gamma);
  return one + z + z * z;
}

StepMatrix velocity_verlet(long double h, long double kappa, long double gamma) {
  const long double p = h * gamma, q = h * h * kappa;
  return {1 - q / 2, h * (1 - p / 2), (-q + q * q / 4 + p * q / 2) / h,
          1 - p + p * p / 2 - q / 2 + p * q / 4};
}

StepMatrix implicit_euler(long double h, long double kappa, long double gamma) {
  const long double determinant = 1 + h * gamma + h * h * kappa;
  return 1 / determinant * StepMatrix{1 + h * gamma, h, -h * kappa, 1};
}

double symplectic_euler_limit(double kappa, double gamma) {
  // (−γ + √(γ² + 4κ))/κ without its cancellation for small κ.
  return 4.0 / (gamma + std::hypot(gamma, 2.0 * std::sqrt(kappa)));
}

double velocity_verlet_limit(double kappa, double gamma) {
  // An eigenvalue leaves at 1 where hγ = 2, or before that at −1 where h²(κ − γ²) + 2hγ = 4.
  const double root_kappa = std::sqrt(kappa);
  if (root_kappa <= gamma) return 2.0 / gamma;
  const double small = std::sqrt(3.0) * gamma, large = 2.0 * root_kappa;
  return 4.0 / (gamma + std::sqrt(large - small) * std::sqrt(large + small));
}

}  // namespace integrator_rows

const IntegratorRow& row_of(Integrator integrator) {
  const auto row = std::find_if(integrator_table.begin(), integrator_table.end(),
                                [=](const IntegratorRow& r) { return r.integrator == integrator; });
  assert(row != integrator_table.end());
  return *row;
}

std::string_view name_of(Integrator integrator) {
  return row_of(integrator).name;
}

int force_evaluations_per_step(Integrator integrator) {
  const Staged* const staged = row_of(integrator).staged();
  return staged ? static_cast<int>(staged->stages.size()) : 0;
}

double free_fall_lead(Integrator integrator) {
  const Staged& flight = *free_flight_row(integrator).staged();
  if (flight.drift == Drift::new_velocity) return 1.0;
  double lead = 0.0;
  for (std::size_t s = 1; s < flight.stages.size(); ++s)
    lead += flight.stages[s].weight * flight.stages[s - 1].advance;
  return lead / flight.divisor;
}

const IntegratorRow& free_flight_row(Integrator integrator) {
  const IntegratorRow& row = row_of(integrator);
  return row.staged() ? row : row_of(Integrator::symplectic_euler);
}

}  // namespace aspic
