#include "analysis/amplification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <utility>

namespace aspic {
namespace {

/// The growth of a mode's norm after many steps: its step matrix applied again and again.
double growth(Integrator integrator, double kappa, double gamma, double h, int steps) {
  const StepMatrix m = row_of(integrator).step_matrix(h, kappa, gamma);
  const long double scale = kappa > 0.0 ? std::sqrt(kappa) : 1.0;
  long double x = 1.0, v = kappa > 0.0 ? 0.3 * std::sqrt(kappa) : 1.0;
  const long double start = std::hypot(x * scale, v);
  for (int i = 0; i < steps && std::hypot(x * scale, v) < 1e6L * start; ++i) {
    const long double next = m[0] * x + m[1] * v;
    v = m[2] * x + m[3] * v;
    x = next;
  }
  return static_cast<double>(std::hypot(x * scale, v) / start);
}

// The stages make the same polynomial of Z as the step matrix states.
TEST(Amplification, StagesAndStepMatrixAreTheSameMethod) {
  for (const IntegratorRow& row : integrator_table) {
    const Staged* const staged = row.staged();
    if (!staged || staged->drift != Drift::stage_velocity) continue;
    const auto r = amplification_polynomial(*staged);
    // A nilpotent-free case: κ = 0 leaves q̇' = R(−hγ)·q̇.
    for (const double z : {-0.1, -0.7, -1.9}) {
      double value = 0.0;
      for (std::size_t i = r.size(); i-- > 0;) value = value * z + r[i];
      EXPECT_NEAR(static_cast<double>(row.step_matrix(1.0L, 0.0L, -z)[3]), value, 1e-14) << row.name;
    }
  }
}

struct Mode {
  double kappa, gamma;
};

void PrintTo(const Mode& mode, std::ostream* os) {
  *os << "kappa " << mode.kappa << ", gamma " << mode.gamma;
}

class ModeLimit : public testing::TestWithParam<std::tuple<Integrator, Mode>> {};

// 2 % below the limit a mode must not grow, 2 % above it must: 30,000 steps amplify even the slowest growth.
TEST_P(ModeLimit, SeparatesDecayFromGrowth) {
  const auto [integrator, mode] = GetParam();
  const auto limit = mode_limit(integrator, mode.kappa, mode.gamma);
  ASSERT_TRUE(limit.has_value());
  ASSERT_TRUE(std::isfinite(*limit));
  // A non-normal step matrix may grow at first: by less than the condition of its eigenvectors, far below
  // 10³.
  EXPECT_LT(growth(integrator, mode.kappa, mode.gamma, 0.98 * *limit, 30000), 1e3);
  EXPECT_GT(growth(integrator, mode.kappa, mode.gamma, 1.02 * *limit, 30000), 1e3);
}

INSTANTIATE_TEST_SUITE_P(AllMethods, ModeLimit,
                         testing::Combine(testing::ValuesIn(explicit_integrators),
                                          testing::Values(Mode{33700.0, 1011.0}, Mode{100.0, 4.0},
                                                          Mode{1.0, 1.9}, Mode{1.0, 2.1}, Mode{0.0, 5.0})));

TEST(ModeLimit, UndampedModesAsTheLiteratureHasThem) {
  EXPECT_FALSE(mode_limit(Integrator::explicit_euler, 4.0, 0.0).has_value());
  EXPECT_FALSE(mode_limit(Integrator::midpoint, 4.0, 0.0).has_value());
  EXPECT_DOUBLE_EQ(*mode_limit(Integrator::symplectic_euler, 4.0, 0.0), 1.0);           // 2/ω
  EXPECT_NEAR(*mode_limit(Integrator::runge_kutta_4, 4.0, 0.0), std::sqrt(2.0), 1e-9);  // 2√2/ω
  EXPECT_NEAR(*mode_limit(Integrator::heun_3, 4.0, 0.0), 0.5 * std::sqrt(3.0), 1e-9);   // √3/ω
  EXPECT_DOUBLE_EQ(*mode_limit(Integrator::velocity_verlet, 4.0, 0.0), 1.0);            // 2/ω
  // R = 1 + z + z²: |R(iy)|² = 1 − y² + y⁴ ≤ 1 for y ≤ 1.
  EXPECT_NEAR(*mode_limit(Integrator::implicit_euler_one_pass, 4.0, 0.0), 0.5, 1e-9);  // 1/ω
}

TEST(ModeLimit, WeaklyDampedExplicitEulerIsLimitedByDampingOverStiffness) {
  // |1 + hλ|² = 1 + 2h Re λ + h²|λ|²: the limit is γ/κ for complex λ.
  EXPECT_NEAR(*mode_limit(Integrator::explicit_euler, 1e4, 1.0), 1e-4, 1e-12);
  EXPECT_NEAR(*mode_limit(Integrator::explicit_euler, 1e4, 1e-3), 1e-7, 1e-15);
}

// Both forms of the limit give 2/γ at κ = γ², where they meet.
TEST(ModeLimit, DampedVelocityVerlet) {
  EXPECT_DOUBLE_EQ(*mode_limit(Integrator::velocity_verlet, 9.0, 3.0), 2.0 / 3.0);
  EXPECT_NEAR(*mode_limit(Integrator::velocity_verlet, 9.0 * (1 + 1e-9), 3.0), 2.0 / 3.0, 1e-8);
  EXPECT_DOUBLE_EQ(*mode_limit(Integrator::velocity_verlet, 1.0, 3.0), 2.0 / 3.0);
  // 4/(1 + √13)
  EXPECT_DOUBLE_EQ(*mode_limit(Integrator::velocity_verlet, 4.0, 1.0), 4.0 / (1.0 + std::sqrt(13.0)));
}

TEST(ModeLimit, NothingLimitsImplicitEulerOrAFreeParticle) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(*mode_limit(Integrator::implicit_euler, 1e9, 0.0), infinity);
  for (const Integrator integrator : explicit_integrators)
    EXPECT_EQ(*mode_limit(integrator, 0.0, 0.0), infinity);
}

TEST(ModeLimit, IsZeroForWhatOverflowed) {
  constexpr double infinite = std::numeric_limits<double>::infinity(),
                   none = std::numeric_limits<double>::quiet_NaN();
  for (const Integrator integrator : explicit_integrators) {
    for (const auto& [kappa, gamma] : std::initializer_list<std::pair<double, double>>{
             {infinite, 0.0}, {0.0, infinite}, {infinite, infinite}, {none, 1.0}, {1.0, none}})
      EXPECT_EQ(*mode_limit(integrator, kappa, gamma), 0.0) << static_cast<int>(integrator);
    // Large numbers that are some are no such case.
    EXPECT_GT(mode_limit(integrator, 1e300, 1e150).value_or(1.0), 0.0);
  }
  EXPECT_EQ(*mode_limit(Integrator::implicit_euler, none, none), infinite);
}

}  // namespace
}  // namespace aspic
