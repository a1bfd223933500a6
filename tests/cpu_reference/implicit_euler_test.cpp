#include "cpu_reference/implicit_euler.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "cpu_reference/all_forces.h"
#include "cpu_reference/phase.h"
#include "support/model_building.h"

namespace aspic::reference {
namespace {

/// A 4³ cube that is squashed, sheared and spinning: springs stretched and compressed by up to a third.
Model deformed_cube() {
  ModelSettings settings = test::cube_on_plane(4, 1.5);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.simulation.implicit.newton_iterations = 100;
  Model model = test::build(settings);
  for (std::size_t i = 0; i < model.initial_position.size(); ++i) {
    const Vec3 start = model.initial_position[i];
    const Vec3 x = {1.1 * start.x + 0.2 * start.y, 0.7 * start.y, 1.05 * start.z};
    model.initial_position.set(i, x);
    model.initial_velocity.set(i, {-3.0 * x.z + 0.2 * x.y, -5.0, 3.0 * x.x});
  }
  return model;
}

// The residual of the definition itself, with the force evaluated by the explicit methods' code at x + h·v',
// v', away from the ground or with the course model's contact force held. implicit_ground_test.cpp has the
// ground.
TEST(ImplicitEuler, SolvesTheEquationItIsNamedAfter) {
  for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
    Model model = deformed_cube();
    model.contact.model = contact;
    if (contact == ContactModel::coulomb) model.terrain.clear();
    const Dynamics<double> dynamics(model);
    ImplicitEuler<double> method(dynamics, model);
    const double h = model.simulation.timestep;
    Phase<double> s = start_of(model);
    for (int n = 0; n < 5; ++n) {
      SolveReport report;
      const Phase<double> next = method.step(s, report);
      EXPECT_EQ(report.end, SolveEnd::converged);
      Model without_contact = model;
      without_contact.contact.model = ContactModel::coulomb;
      const Dynamics<double> springs(without_contact);
      Field<double> held = test::AllForces(dynamics).contact_force(s.x, s.v);
      for (Eigen::Index i = 0; i < held.cols(); ++i) held.col(i) *= dynamics.inverse_mass(i);
      const Field<double> R =
          next.v - s.v - h * (test::AllForces(springs).acceleration(next.x, next.v) + held);
      // Tolerance 1e-9, and x' rounded to the ulp of 4 m feeds k·h·26 springs of 2,000 N/m: 2e-12·h.
      EXPECT_LE(R.cwiseAbs().maxCoeff(), 1e-9 + 1e-11);
      EXPECT_TRUE((next.x.array() == (s.x + h * next.v).array()).all());
      s = next;
    }
  }
}

// A body that touches nothing falls by h·g and turns no spring: that is where the solve begins.
TEST(ImplicitEuler, NeedsNoIterationInFreeFlight) {
  ModelSettings settings = test::cube_on_plane(4, 5.0);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  Model model = test::build(settings);
  const Dynamics<double> dynamics(model);
  ImplicitEuler<double> method(dynamics, model);
  SolveReport report;
  const Phase<double> next = method.step(start_of(model), report);
  EXPECT_EQ(report.end, SolveEnd::converged);
  EXPECT_EQ(report.newton_iterations, 0u);
  const double h = model.simulation.timestep;
  EXPECT_TRUE((next.v.row(1).array() == -9.8 * h).all());
  // Not where a pinned particle holds the body: then v is nearer to the solution than the fall, or is not,
  // but either way the equation decides.
  model.inverse_mass.set(0, 0.0);
  const Dynamics<double> pinned(model);
  ImplicitEuler<double> again(pinned, model);
  const Phase<double> held = again.step(start_of(model), report);
  EXPECT_EQ(report.end, SolveEnd::converged);
  EXPECT_GT(report.newton_iterations, 0u);
  EXPECT_EQ(held.v(1, 0), 0.0);
  EXPECT_GT(held.v(1, 1), -9.8 * h) << "its neighbor is held back";
}

// A dense Newton's method with finite-difference Jacobian knows nothing of springs, blocks or conjugate
// gradients.
TEST(ImplicitEuler, EqualsADenseSolve) {
  const Model model = deformed_cube();
  const Dynamics<double> dynamics(model);
  const double h = model.simulation.timestep;
  const Phase<double> s = start_of(model);
  const Eigen::Index dof = 3 * s.x.cols();
  const auto residual = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    const Field<double> field = Eigen::Map<const Field<double>>(v.data(), 3, s.x.cols());
    const Field<double> R = field - s.v - h * test::AllForces(dynamics).acceleration(s.x + h * field, field);
    return Eigen::Map<const Eigen::VectorXd>(R.data(), dof);
  };
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(s.v.data(), dof);
  for (int n = 0; n < 30; ++n) {
    const Eigen::VectorXd R = residual(v);
    if (R.cwiseAbs().maxCoeff() < 1e-12) break;
    Eigen::MatrixXd J(dof, dof);
    const double step = 1e-6;
    for (Eigen::Index c = 0; c < dof; ++c) {
      Eigen::VectorXd up = v, down = v;
      up[c] += step;
      down[c] -= step;
      J.col(c) = (residual(up) - residual(down)) / (2 * step);
    }
    v -= J.partialPivLu().solve(R);
  }
  ASSERT_LT(residual(v).cwiseAbs().maxCoeff(), 1e-11);
  ImplicitEuler<double> method(dynamics, model);
  SolveReport report;
  const Phase<double> solved = method.step(s, report);
  EXPECT_LE((Eigen::Map<const Eigen::VectorXd>(solved.v.data(), dof) - v).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ImplicitEuler, FreeFallMovesWithTheNewVelocity) {
  Model model = test::particles({{1, 2, 3}}, {{0.5, 4, -1}});
  model.simulation.timestep = 0.01;
  const Dynamics<double> dynamics(model);
  ImplicitEuler<double> method(dynamics, model);
  Phase<double> s = start_of(model);
  const int n = 200;
  SolveReport report;
  for (int step = 0; step < n; ++step) s = method.step(s, report);
  const double eps = n * 2.3e-16 * 40.0;
  EXPECT_NEAR(s.v(1, 0), 4.0 - n * 0.01 * 9.8, eps);
  EXPECT_NEAR(s.x(1, 0), 2.0 + n * 0.01 * 4.0 - 9.8 * 1e-4 * n * (n + 1) / 2.0, eps);
}

// Stiff and damped: at a thousand times explicit Euler's limit the spring must only relax.
TEST(ImplicitEuler, OneSpringFollowsTheResolvent) {
  const double k = 50.0, c = 0.4, h = 0.05, stretch = 0.01;
  Model model = test::particles({{1.0 + stretch, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  model.simulation.timestep = h;
  model.simulation.gravity = {0, 0, 0};
  model.simulation.implicit.tolerance = 1e-15;
  model.spring_classes.push_back({SpringType::structural, k, c, 1.0, false});
  model.listed_springs.push_back({0, 1, 0});
  const Dynamics<double> dynamics(model);
  ImplicitEuler<double> method(dynamics, model);
  Phase<double> s = start_of(model);
  // e = x₀ − x₁ − r and its rate u: u' = u − 2h(k·e' + c·u'), e' = e + h·u' for two masses of 1 kg.
  double e = stretch, u = 0.0;
  SolveReport report;
  for (int n = 0; n < 300; ++n) {
    s = method.step(s, report);
    u = (u - 2 * h * k * e) / (1 + 2 * h * c + 2 * h * h * k);
    e += h * u;
    ASSERT_NEAR(s.x(0, 0) - s.x(0, 1) - 1.0, e, 1e-12);
    ASSERT_NEAR(s.v(0, 0) - s.v(0, 1), u, 1e-12);
  }
}

TEST(ImplicitEuler, SaysHowEachSolveEnded) {
  Model model = deformed_cube();
  SolveReport report;
  const Phase<double> s = start_of(model);
  {
    const Dynamics<double> dynamics(model);
    ImplicitEuler<double>(dynamics, model).step(s, report);
    EXPECT_EQ(report.end, SolveEnd::converged);
    EXPECT_LE(report.residual, 1e-9);
    EXPECT_GT(report.newton_iterations, 1u);
    EXPECT_GE(report.cg_iterations, report.newton_iterations);
  }
  {
    Model few = model;
    few.simulation.implicit.newton_iterations = 1;
    const Dynamics<double> dynamics(few);
    ImplicitEuler<double>(dynamics, few).step(s, report);
    EXPECT_EQ(report.end, SolveEnd::not_converged);
    EXPECT_EQ(report.newton_iterations, 1u);
    EXPECT_GT(report.residual, 1e-9);
  }
  {
    Model strict = model;
    strict.simulation.implicit.tolerance = 1e-30;
    const Dynamics<double> dynamics(strict);
    ImplicitEuler<double>(dynamics, strict).step(s, report);
    EXPECT_EQ(report.end, SolveEnd::stagnated);
    EXPECT_LT(report.residual, 1e-11);  // it went down to rounding before it gave up
  }
}

TEST(ImplicitEuler, MatrixOfACompressedSpringIsPositive) {
  const SpringConstants<double> spring(SpringClass{SpringType::structural, 2000.0, 60.0, 1.0, false});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n = 0; n < 1000; ++n) {
    const Vector<double> e(any(random), any(random), any(random)),
        v(any(random) * 9, any(random) * 9, any(random) * 9);
    const auto [f, H] = linearized<double>(spring, 0.02, e, v);
    const Vector<double> d(any(random), any(random), any(random));
    EXPECT_GE(dot3<double>(d, H * d), 0.0);
    EXPECT_EQ(f, spring_force<double>(spring, e, v));
  }
}

TEST(ImplicitEuler, BlockInverseIsAnInverse) {
  DiagonalBlock<double> b(2.0);
  b.add({3.0, 0.5, Vector<double>(0.6, 0.0, 0.8)});
  b.add({1.0, 0.0, Vector<double>(0.0, 0.6, -0.8)});
  const DiagonalBlock<double> inverse = b.inverse();
  for (int axis = 0; axis < 3; ++axis) {
    const Vector<double> unit = Vector<double>::Unit(axis);
    EXPECT_NEAR((inverse * (b * unit) - unit).norm(), 0.0, 1e-15);
  }
}

}  // namespace
}  // namespace aspic::reference
