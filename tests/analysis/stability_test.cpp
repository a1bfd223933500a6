#include "analysis/stability.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "analysis/amplification.h"
#include "analysis/dense.h"
#include "analysis/spectrum.h"
#include "model/springs.h"
#include "support/integrator_names.h"
#include "support/lattice_bodies.h"

namespace aspic {
namespace {

CubeSettings cube_settings(int n) {
  CubeSettings cube;
  cube.particles_per_edge = n;
  return cube;
}

Model model_of(const CubeSettings& cube) {
  ModelSettings settings;
  settings.cubes.push_back(cube);
  auto model = build_model(settings);
  EXPECT_TRUE(model.ok());
  return std::move(model).value();
}

/// Spectral radius of the step matrix of an integrator for the whole linearized model, its stages applied to
/// dense K and C.
double spectral_radius(const Model& model, Integrator integrator, double h) {
  const auto dof = 3 * static_cast<Eigen::Index>(model.particle_count());
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(dof, dof), c = k;
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& s = model.spring_classes[spring.spring_class];
    const Vec3 e = model.initial_position[spring.a] - model.initial_position[spring.b];
    const Eigen::Vector3d n = Eigen::Vector3d(e.x, e.y, e.z).normalized();
    Eigen::VectorXd g = Eigen::VectorXd::Zero(dof);
    g.segment<3>(3 * Eigen::Index{spring.a}) = n;
    g.segment<3>(3 * Eigen::Index{spring.b}) = -n;
    k += s.stiffness * g * g.transpose();
    c += s.damping * g * g.transpose();
  }
  for (Eigen::Index i = 0; i < dof; ++i) {
    k.row(i) *= model.inverse_mass[static_cast<std::size_t>(i / 3)];
    c.row(i) *= model.inverse_mass[static_cast<std::size_t>(i / 3)];
  }
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * dof, 2 * dof);
  a.topRightCorner(dof, dof).setIdentity();
  a.bottomLeftCorner(dof, dof) = -k;
  a.bottomRightCorner(dof, dof) = -c;
  for (Eigen::Index i = 0; i < dof; ++i) {
    if (model.inverse_mass[static_cast<std::size_t>(i / 3)] == 0.0) a(i, dof + i) = 0.0;
  }
  const Eigen::MatrixXd z = h * a, one = Eigen::MatrixXd::Identity(2 * dof, 2 * dof);
  const Staged& method = *row_of(integrator).staged();
  Eigen::MatrixXd at = one, sum = Eigen::MatrixXd::Zero(2 * dof, 2 * dof);
  for (const Stage& s : method.stages) {
    const Eigen::MatrixXd slope = z * at;
    sum += s.weight / method.divisor * slope;
    Eigen::MatrixXd next = one + s.advance * slope;
    if (method.drift == Drift::mean_velocity) {
      const Eigen::MatrixXd mean = 0.5 * (at.bottomRows(dof) + next.bottomRows(dof));
      next.topRows(dof) = one.topRows(dof) + s.advance * h * mean;
    }
    at = next;
  }
  Eigen::MatrixXd step = one + sum;
  if (method.drift == Drift::new_velocity) step.topRows(dof) = one.topRows(dof) + h * step.bottomRows(dof);
  double largest = 0.0;
  for (const std::complex<double>& value : eigenvalues(step)) largest = std::max(largest, std::abs(value));
  return largest;
}

// Figures of docs/physics.md, given there to four digits.
TEST(Stability, DefaultCubeHasThePublishedEigenvalueAndSteps) {
  const Model model = model_of(cube_settings(10));
  EXPECT_NEAR(largest_stiffness_eigenvalue(model) / 2000.0, 16.850, 0.0005);
  const auto step = [&](Integrator integrator) {
    const StabilityLimit limit = stability_limit(model, integrator);
    EXPECT_TRUE(limit.exact);
    return limit.step.value_or(-1.0);
  };
  EXPECT_NEAR(step(Integrator::explicit_euler), 0.002048, 5e-7);
  EXPECT_NEAR(step(Integrator::midpoint), 0.002048, 5e-7);
  EXPECT_NEAR(step(Integrator::implicit_euler_one_pass), 0.001024, 5e-7);
  EXPECT_NEAR(step(Integrator::runge_kutta_4), 0.002852, 5e-7);
  EXPECT_NEAR(step(Integrator::symplectic_euler), 0.001917, 5e-7);
  EXPECT_EQ(step(Integrator::implicit_euler), std::numeric_limits<double>::infinity());
}

TEST(Stability, DefaultCubeBearsTheNominalStepOfEveryMethod) {
  const Model model = model_of(cube_settings(10));
  for (const IntegratorRow& row : integrator_table) {
    const StabilityLimit limit = stability_limit(model, row.integrator);
    EXPECT_FALSE(exceeds(row.traits.nominal_step, limit)) << row.name;
    EXPECT_EQ(std::isinf(limit.step.value_or(0.0)), row.traits.stable_at_any_step) << row.name;
  }
}

TEST(Stability, QuickEffortAgreesWithThoroughOnTheDefaultCube) {
  const Model model = model_of(cube_settings(10));
  for (const Integrator integrator : explicit_integrators) {
    const double thorough = *stability_limit(model, integrator).step;
    // Quick Lanczos stops at a residual of 1e-4: the eigenvalue is then off by at most that share.
    EXPECT_NEAR(*stability_limit(model, integrator, StabilityEffort::quick).step, thorough, 2e-4 * thorough);
  }
}

// What is certain from the infinite lattice must be stable by the cube's own spectrum, and the other way
// round but for the lattice's small surplus (17.633 against 16.850 at n = 10).
TEST(Stability, InfiniteLatticeClearsStableStepsOfBoxesAndOfBodiesWithEmptyCells) {
  ModelSettings settings = test::cube_on_plane(2);
  settings.cubes[0].particles = {9, 2, 4};
  for (const Model& model :
       {test::build(settings), test::with_cells(settings, test::lattice_of("xxx,x.x,xxx;xxx,...,x.."))}) {
    for (const Integrator integrator : explicit_integrators) {
      const double limit = *stability_limit(model, integrator).step;
      EXPECT_TRUE(certainly_stable(model, integrator, 0.5 * limit)) << name_of(integrator);
      EXPECT_FALSE(certainly_stable(model, integrator, 1.0001 * limit)) << name_of(integrator);
    }
  }
}

TEST(Stability, InfiniteLatticeClearsOnlyStableSteps) {
  for (const double damping : {60.0, 5.0, 0.5}) {
    CubeSettings cube = cube_settings(10);
    cube.structural.damping = cube.shear.damping = cube.bending.damping = damping;
    Model model = model_of(cube);
    for (const double drag : {0.0, 500.0})
      for (const Integrator integrator : explicit_integrators) {
        model.simulation.drag = drag;
        const double limit = *stability_limit(model, integrator).step;
        EXPECT_FALSE(certainly_stable(model, integrator, 1.0001 * limit)) << name_of(integrator) << damping;
        EXPECT_TRUE(certainly_stable(model, integrator, 0.93 * limit)) << name_of(integrator) << damping;
      }
  }
}

TEST(Stability, UndampedCube) {
  CubeSettings cube = cube_settings(4);
  cube.structural.damping = cube.shear.damping = cube.bending.damping = 0.0;
  const Model model = model_of(cube);
  EXPECT_FALSE(stability_limit(model, Integrator::explicit_euler).step.has_value());
  EXPECT_FALSE(stability_limit(model, Integrator::midpoint).step.has_value());
  const double omega = std::sqrt(largest_stiffness_eigenvalue(model));
  EXPECT_NEAR(*stability_limit(model, Integrator::symplectic_euler).step, 2.0 / omega, 1e-6 / omega);
  EXPECT_NEAR(*stability_limit(model, Integrator::runge_kutta_4).step, 2.0 * std::sqrt(2.0) / omega,
              1e-6 / omega);
  EXPECT_NEAR(*stability_limit(model, Integrator::implicit_euler_one_pass).step, 1.0 / omega, 1e-6 / omega);
}

TEST(Stability, WeaklyDampedExplicitEulerIsLimitedByDampingOverStiffness) {
  CubeSettings cube = cube_settings(5);
  cube.structural.damping = cube.shear.damping = cube.bending.damping = 1.0;
  const StabilityLimit limit = stability_limit(model_of(cube), Integrator::explicit_euler);
  EXPECT_NEAR(*limit.step, 1.0 / 2000.0, 1e-9);
}

TEST(Stability, ModelWithoutSpringForcesHasNoLimit) {
  CubeSettings cube = cube_settings(3);
  cube.structural = cube.shear = cube.bending = {0.0, 0.0};
  for (const Integrator integrator : explicit_integrators) {
    EXPECT_EQ(*stability_limit(model_of(cube), integrator).step, std::numeric_limits<double>::infinity());
    EXPECT_EQ(*stability_limit(Model{}, integrator).step, std::numeric_limits<double>::infinity());
  }
}

TEST(Stability, PureDampingIsARealSpectrum) {
  CubeSettings cube = cube_settings(3);
  cube.structural = cube.shear = cube.bending = {0.0, 60.0};
  const Model damped = model_of(cube);
  cube.structural = cube.shear = cube.bending = {60.0, 0.0};
  const double gamma = largest_stiffness_eigenvalue(model_of(cube));
  EXPECT_NEAR(*stability_limit(damped, Integrator::explicit_euler).step, 2.0 / gamma, 1e-9);
  EXPECT_NEAR(*stability_limit(damped, Integrator::symplectic_euler).step, 2.0 / gamma, 1e-9);
}

/// Whether the limit of springs with different damping ratios follows from eigenvalues of the body: of a
/// Runge–Kutta method from those of the first-order system, of symplectic Euler from λ_max(h²K + 2hC) = 4.
/// Other step matrices do not divide into modes, and what stability_limit gives is a bound.
bool known_exactly(Integrator integrator) {
  return !row_of(integrator).staged()->mode_limit || integrator == Integrator::symplectic_euler;
}

class MixedCube : public testing::TestWithParam<Integrator> {};

// Springs of three different damping ratios and a pinned face: the spectral radius of the whole step matrix
// must pass 1 at the limit. Rigid motion has eigenvalue 1, a defective pair: rounding moves it by about √ε
// ≈ 1.5e-8 times the size.
TEST_P(MixedCube, SpectralRadiusPassesOneAtTheLimit) {
  CubeSettings cube = cube_settings(3);
  cube.structural = {2000.0, 60.0};
  cube.shear = {500.0, 2.0};
  cube.bending = {1000.0, 100.0};
  cube.pinned.names = {"top"};
  const Model model = model_of(cube);
  const StabilityLimit limit = stability_limit(model, GetParam());
  ASSERT_TRUE(limit.step.has_value());
  EXPECT_EQ(limit.exact, known_exactly(GetParam()));
  for (const double share : {0.25, 0.5, 0.75, 0.999})
    EXPECT_LE(spectral_radius(model, GetParam(), share * *limit.step), 1.0 + 1e-6) << share;
  // A bound is no more than half below.
  EXPECT_GT(spectral_radius(model, GetParam(), (limit.exact ? 1.001 : 2.0) * *limit.step), 1.0 + 1e-6);
}

// A body too large for the dense solve gets a bound that the dense solve of the same body never falls below.
TEST_P(MixedCube, BoundOfALargeBodyIsBelowItsExactLimit) {
  CubeSettings cube = cube_settings(4);
  cube.structural = {2000.0, 60.0};
  cube.shear = {1500.0, 50.0};
  cube.bending = {1000.0, 35.0};
  const Model model = model_of(cube);
  const StabilityLimit exact = stability_limit(model, GetParam(), StabilityEffort::thorough);
  const StabilityLimit bound = stability_limit(model, GetParam(), StabilityEffort::quick);
  ASSERT_TRUE(exact.step && bound.step);
  EXPECT_EQ(exact.exact, known_exactly(GetParam()));
  EXPECT_EQ(bound.exact, GetParam() == Integrator::symplectic_euler);
  EXPECT_LE(*bound.step, *exact.step * (1.0 + 2e-4));
  EXPECT_GE(*bound.step, 0.5 * *exact.step);
}

INSTANTIATE_TEST_SUITE_P(AllMethods, MixedCube, testing::ValuesIn(explicit_integrators), test::by_integrator);

TEST(Stability, OfTwoBodiesTheStifferDecides) {
  ModelSettings settings;
  settings.cubes = {cube_settings(3), cube_settings(3)};
  settings.cubes[1].structural.stiffness = settings.cubes[1].shear.stiffness =
      settings.cubes[1].bending.stiffness = 9000.0;
  settings.cubes[1].structural.damping = settings.cubes[1].shear.damping = settings.cubes[1].bending.damping =
      200.0;
  const auto both = build_model(settings);
  ASSERT_TRUE(both.ok());
  const double stiff = *stability_limit(model_of(settings.cubes[1]), Integrator::explicit_euler).step;
  EXPECT_LT(stiff, *stability_limit(model_of(settings.cubes[0]), Integrator::explicit_euler).step);
  EXPECT_NEAR(*stability_limit(*both, Integrator::explicit_euler).step, stiff, 1e-9);
}

// Springs of very different damping ratios: Lanczos iterates and dense solves come to an end at their budget.
TEST(Stability, WorkIsBoundedAndWhatIsLeftOutIsBounded) {
  ModelSettings settings;
  for (int c = 0; c < 40; ++c) {
    CubeSettings cube = cube_settings(5);
    cube.structural = {2000.0 + c, 60.0};
    cube.shear = {1e-3, 2.0};
    cube.bending = {1e9, 100.0};
    settings.cubes.push_back(cube);
  }
  const auto model = build_model(settings);
  ASSERT_TRUE(model.ok());
  for (const Integrator integrator : explicit_integrators) {
    int looks = 0;
    double share = 0.0;
    const auto watch = [&](double done) {
      EXPECT_GE(done, share);
      EXPECT_LE(done, 1.0);
      share = done;
      return ++looks < 3;
    };
    const StabilityLimit cut = stability_limit(*model, integrator, StabilityEffort::thorough, watch);
    EXPECT_EQ(looks, 3) << "nothing asks again once the work is called off";
    ASSERT_TRUE(cut.step.has_value());
    EXPECT_FALSE(cut.exact);
    // The stiffest of the cubes decides, and what is not looked at is not thought stabler than it is.
    ModelSettings last;
    last.cubes = {settings.cubes.back()};
    const auto alone = build_model(last);
    EXPECT_LE(*cut.step, *stability_limit(*alone, integrator, StabilityEffort::quick).step * (1.0 + 1e-4));
    EXPECT_GT(*cut.step, 0.0);
  }
}

TEST(Stability, GershgorinBoundIsAboveTheEigenvalue) {
  for (const int n : {2, 4, 7}) {
    CubeSettings cube = cube_settings(n);
    cube.shear.stiffness = 30.0;
    cube.bending.stiffness = 9000.0;
    const Model model = model_of(cube);
    const LinearizedBody body(model, 0, model.particle_count());
    WorkBudget work(1000000000);
    for (const auto& [k, c] : {std::pair(1.0, 0.0), std::pair(0.0, 1.0), std::pair(1e-6, 2e-3)}) {
      const LargestEigenvalue largest = body.largest_eigenvalue(k, c, 1e-7, 1000, work);
      EXPECT_TRUE(largest.converged);
      EXPECT_GE(body.eigenvalue_bound(k, c), largest.value);
      EXPECT_LE(body.eigenvalue_bound(k, c), 12.0 * largest.value);
      // Cut short it is still above.
      const LargestEigenvalue cut = body.largest_eigenvalue(k, c, 1e-15, 20, work);
      EXPECT_GE(cut.value, largest.value * (1.0 - 1e-6));
    }
  }
}

TEST(Stability, AfterADivergenceASmallerStepIsOfferedWhateverTheEstimate) {
  EXPECT_EQ(step_to_try(0.02, {0.002048, true}), 0.0019);
  EXPECT_EQ(step_to_try(0.001, {0.002, true}), 0.0005) << "a hit needed less than small motions do";
  EXPECT_EQ(step_to_try(0.02, {std::numeric_limits<double>::infinity(), true}), 0.01);
  EXPECT_EQ(step_to_try(0.001, {std::nullopt, true}), std::nullopt);
  EXPECT_EQ(step_to_try(0.001, {0.0, false}), std::nullopt);
  for (const double limit : {1e-5, 3.3e-4, 1e-3, 1.04e-3, 1.06e-3, 0.5})
    EXPECT_LT(*step_to_try(0.001, {limit, true}), 0.001) << limit;
  const auto of = [](double step, double limit) {
    return divergence_sentence(step, Integrator::explicit_euler, {limit, true});
  };
  EXPECT_EQ(of(0.02, 0.002048),
            "The time step is 0.02 s; the largest stable one for explicit-euler is estimated at 0.002048 s.");
  EXPECT_EQ(
      of(0.0018000000000000002, 0.002),
      "The time step is 0.0018 s, and small motions are stable under explicit-euler up to 0.002 s; a hit "
      "or a contact needed a smaller one. Try 0.0009 s.");
}

TEST(Stability, OverflowHasAnAnswer) {
  Model model = model_of(cube_settings(2));
  model.inverse_mass.assign(model.particle_count(), 1e308);
  for (const Integrator integrator : explicit_integrators) {
    const StabilityLimit limit = stability_limit(model, integrator);
    EXPECT_EQ(limit.step.value_or(-1.0), 0.0);
    EXPECT_FALSE(limit.exact);
    EXPECT_FALSE(certainly_stable(model, integrator, 1e-9));
  }
}

}  // namespace
}  // namespace aspic
