// Pulling a particle: against closed forms, against the spring it stands for, and against its own definition.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "cpu_reference/all_forces.h"
#include "cpu_reference/implicit_euler.h"
#include "cpu_reference/phase.h"
#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "support/epsilon.h"
#include "support/integrator_names.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::eps;

/// What one step makes of (position, velocity) of a linear oscillator.
Eigen::Matrix2d amplification(Integrator integrator, double h, double k, double c, double m) {
  const StepMatrix step = row_of(integrator).step_matrix(h, k / m, c / m);
  Eigen::Matrix2d matrix;
  for (Eigen::Index i = 0; i < 4; ++i)
    matrix(i / 2, i % 2) = static_cast<double>(step[static_cast<std::size_t>(i)]);
  return matrix;
}

class PullClosedForm : public testing::TestWithParam<Integrator> {
 protected:
  /// A particle of 2 kg without gravity, tugged at `c`; the largest difference from the amplification matrix
  /// over 500 steps.
  static double deviation(const Vec3& from_anchor, const Vec3& velocity, double c) {
    const Vec3 anchor{1.0, -2.0, 0.5};
    const double k = 30.0, m = 2.0, h = 0.002;
    Model model = test::particles({anchor + from_anchor}, {velocity}, m);
    model.simulation.gravity = {};
    model.simulation.timestep = h;
    model.simulation.integrator = GetParam();
    model.simulation.implicit.tolerance = 1e-15;
    auto solver = test::solver_for(model, Precision::double_);
    EXPECT_TRUE(solver->set_inputs({{Pull{0, anchor, k, c}}}).ok());
    const Eigen::Matrix2d R = amplification(GetParam(), h, k, c, m);
    Eigen::Matrix<double, 2, 3> y;
    y << from_anchor.x, from_anchor.y, from_anchor.z, velocity.x, velocity.y, velocity.z;
    double largest = 0.0;
    for (int n = 0; n < 500; ++n) {
      EXPECT_FALSE((*solver->advance(1)).divergence.has_value());
      y = R * y;
      const State state = *solver->state();
      for (int axis = 0; axis < 3; ++axis) {
        largest = std::max(largest, std::abs(state.position[0][axis] - anchor[axis] - y(0, axis)));
        largest = std::max(largest, std::abs(state.velocity[0][axis] - y(1, axis)));
      }
    }
    return largest;
  }
};
INSTANTIATE_TEST_SUITE_P(Every, PullClosedForm, testing::ValuesIn(all_integrators), test::by_integrator);

// Positions up to 3 m are rounded in each of 500 steps and feed a force of 30 N/m over h; an implicit solve
// ends at a residual of 1e-15 m/s or where rounding ends it.
constexpr double bound = 500 * 16 * eps * 3.0;

TEST_P(PullClosedForm, UndampedIsTheIsotropicOscillator) {
  EXPECT_LE(deviation({0.7, 0.2, -0.4}, {0.3, -1.1, 0.6}, 0.0), bound);
}

TEST_P(PullClosedForm, DampedAlongALineIsTheDampedOscillator) {
  // Through the anchor and out on the other side: with rest length 0 the force is linear on the whole line.
  EXPECT_LE(deviation({0.6, 0.3, -0.2}, {-6.0, -3.0, 2.0}, 4.0), bound);
}

TEST(Pull, HangsWhereWeightAndPullBalance) {
  const double k = 100.0, c = 20.0, h = 0.001, g = 9.8;
  for (const Integrator integrator : {Integrator::symplectic_euler, Integrator::runge_kutta_4}) {
    Model model = test::particles({{0.0, 1.0, 0.0}}, {{0.0, 2.0, 0.0}});  // below: damping acts along e
    model.simulation.integrator = integrator;
    model.simulation.timestep = h;
    auto solver = test::solver_for(model, Precision::double_);
    ASSERT_TRUE(solver->set_inputs({{Pull{0, {0.0, 4.0, 0.0}, k, c}}}).ok());
    ASSERT_FALSE((*solver->advance(30000)).divergence.has_value());
    // It comes to rest where h·v, with c·v = k·(distance to the balance), no longer changes a position of 4
    // m.
    EXPECT_NEAR(solver->state()->position[0].y, 4.0 - g / k, 4.0 * eps * (2.0 + c / (h * k)));
  }
}

/// The model with one more particle, pinned at `anchor`, and a spring of rest length 0 to it.
Model with_spring_instead(Model model, const Pull& pull) {
  const std::uint32_t last = model.particle_count();
  model.mass.push_back(1.0);
  model.inverse_mass.push_back(0.0);
  model.initial_position.push_back(pull.anchor);
  model.initial_velocity.push_back({});
  const auto spring_class = static_cast<std::uint32_t>(model.spring_classes.size());
  model.spring_classes.push_back({SpringType::structural, pull.stiffness, pull.damping, 0.0, false});
  // Springs stay sorted; the partner's index is the highest, so its spring is the last of the particle's sum.
  list_springs(model);
  std::vector<Spring>& springs = model.listed_springs;
  const auto after = std::ranges::find_if(springs, [&](const Spring& s) { return s.a > pull.particle; });
  springs.insert(after, Spring{pull.particle, last, spring_class});
  return model;
}

TEST(Pull, IsASpringToAPinnedParticleToTheBit) {
  for (const Integrator integrator : all_integrators) {
    for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
      for (const Precision precision : {Precision::single, Precision::double_}) {
        ModelSettings settings = test::cube_on_plane(3, 1.9);
        settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
        settings.cubes[0].velocity = {1.0, -1.0, 0.5};
        settings.simulation.integrator = integrator;
        if (integrator == Integrator::implicit_euler) settings.simulation.timestep = 0.005;
        settings.contact.model = contact;
        const Model model = test::build(settings);
        const Pull pull{17, {2.0, 3.0, -1.0}, 700.0, 15.0};
        const Model other = with_spring_instead(model, pull);
        auto pulled = test::solver_for(model, precision), sprung = test::solver_for(other, precision);
        ASSERT_TRUE(pulled->set_inputs(inputs_of(pull)).ok());
        const std::uint64_t steps = integrator == Integrator::implicit_euler ? 40 : 200;
        ASSERT_FALSE((*pulled->advance(steps)).divergence.has_value());
        ASSERT_FALSE((*sprung->advance(steps)).divergence.has_value());
        State expected = *sprung->state();
        expected.position.pop_back();
        expected.velocity.pop_back();
        EXPECT_EQ(*pulled->state(), expected) << name_of(integrator) << ", " << name_of(contact);
      }
    }
  }
}

// Before contact: what the ground gives back is the weight less the pull.
TEST(Pull, LightensWhatPressesOnTheGround) {
  Model model = test::particles({{0, -1, 0}}, {{2, 0, 0}}, 3.0);
  model.contact.model = ContactModel::course;
  model.terrain.emplace_back();
  model.terrain[0].geometry.vectors[0] = {0, -1, 0};
  model.terrain[0].friction = 0.5;
  reference::Dynamics<double> dynamics(model);
  const physics::Phase<double> s = reference::start_of(model);
  dynamics.set_inputs({{Pull{0, {0, 1, 0}, 4.0, 9.0}}});
  const double N = 3.0 * 9.8 - 2.0 * 4.0;
  const test::AllForces forces(dynamics);
  const physics::Field<double> f = forces.force(s.x, s.v);
  EXPECT_NEAR(f(0, 0), -0.5 * N * 2.0, 8 * eps * N);
  EXPECT_NEAR(f(1, 0), 0.0, 8 * eps * N);
  EXPECT_NEAR(forces.contact_force(s.x, s.v)(1, 0), N, 8 * eps * N);
  dynamics.set_inputs({});
  EXPECT_NEAR(forces.force(s.x, s.v)(0, 0), -0.5 * (3.0 * 9.8) * 2.0, 8 * eps * 30.0);
}

TEST(Pull, IsPartOfTheEquationThatImplicitEulerSolves) {
  ModelSettings settings = test::cube_on_plane(4, 1.5);
  settings.simulation.timestep = 1.0 / 60.0;
  const Model model = test::build(settings);
  reference::Dynamics<double> dynamics(model);
  reference::ImplicitEuler<double> method(dynamics, model);
  dynamics.set_inputs({{Pull{21, {3.0, 4.0, 0.0}, 5000.0, 40.0}}});
  const double h = model.simulation.timestep;
  physics::Phase<double> s = reference::start_of(model);
  for (int n = 0; n < 10; ++n) {
    SolveReport report;
    const physics::Phase<double> next = method.step(s, report);
    ASSERT_EQ(report.end, SolveEnd::converged);
    const physics::Field<double> R =
        next.v - s.v - h * test::AllForces(dynamics).acceleration(next.x, next.v);
    // Tolerance 1e-9, and x' rounded to the ulp of 8 m feeds the pull and 26 springs of 2,000 N/m.
    EXPECT_LE(R.cwiseAbs().maxCoeff(), 1e-9 + h * 60000.0 * 8.0 * eps);
    s = next;
  }
  EXPECT_GT(s.x(0, 21), reference::start_of(model).x(0, 21) + 0.01);
}

TEST(Pull, HoldsUntilChangedAndSurvivesALoad) {
  const Model model = test::build(test::cube_on_plane(3, 5.0));
  const Pull pull{13, {0.5, 6.0, 0.0}, 400.0, 3.0};
  auto whole = test::solver_for(model, Precision::single), split = test::solver_for(model, Precision::single);
  ASSERT_TRUE(whole->set_inputs(inputs_of(pull)).ok());
  ASSERT_TRUE(split->set_inputs(inputs_of(pull)).ok());
  ASSERT_FALSE((*whole->advance(40)).divergence.has_value());
  ASSERT_FALSE((*split->advance(15)).divergence.has_value());
  ASSERT_TRUE(split->load(*split->state()).ok());
  ASSERT_FALSE((*split->advance(25)).divergence.has_value());
  EXPECT_EQ(*split->state(), *whole->state());

  // Let go: from here on as a new solver, which pulls nobody.
  ASSERT_TRUE(whole->set_inputs({}).ok());
  auto fresh = test::solver_for(model, Precision::single);
  ASSERT_TRUE(fresh->load(*whole->state()).ok());
  ASSERT_FALSE((*whole->advance(20)).divergence.has_value());
  ASSERT_FALSE((*fresh->advance(20)).divergence.has_value());
  EXPECT_EQ(*whole->state(), *fresh->state());
}

TEST(Pull, RefusedLeavesTheOneBefore) {
  const Model model = test::build(test::cube_on_plane(3, 5.0));
  auto one = test::solver_for(model, Precision::single), other = test::solver_for(model, Precision::single);
  ASSERT_TRUE(one->set_inputs({{Pull{13, {0.5, 6.0, 0.0}, 400.0, 3.0}}}).ok());
  ASSERT_TRUE(other->set_inputs({{Pull{13, {0.5, 6.0, 0.0}, 400.0, 3.0}}}).ok());
  EXPECT_EQ(one->set_inputs({{Pull{27, {}, 1.0, 0.0}}}).error().code, ErrorCode::usage);
  EXPECT_EQ(one->set_inputs({{Pull{0, {0.0, 1e39, 0.0}, 1.0, 0.0}}}).error().code, ErrorCode::usage);
  ASSERT_FALSE((*one->advance(20)).divergence.has_value());
  ASSERT_FALSE((*other->advance(20)).divergence.has_value());
  EXPECT_EQ(*one->state(), *other->state());
}

// Damped critically it comes to rest where the pull carries its weight. A place x moves while h·|v| exceeds
// half a unit of x, and the damper lets v be that large where k·δ = c·v: δ ≤ ε·|x|·c/(k·h).
TEST(PullOnABall, HangsAtMgOverK) {
  for (const Integrator integrator : all_integrators) {
    const double k = 200.0, m = 2.0, c = 40.0, h = 0.002;
    ModelSettings settings;
    settings.balls.push_back({0.3, m, {1.0, 3.0, 0.0}, {0.0, 0.5, 0.0}, {1.0, 2.0, 3.0}});
    settings.balls.push_back({0.3, m, {5.0, 3.0, 0.0}, {}, {}});
    settings.simulation.timestep = h;
    settings.simulation.integrator = integrator;
    const Model model = test::build(settings);
    auto solver = test::solver_for(model, Precision::double_);
    ASSERT_TRUE(solver->set_inputs({{Pull{0, {1.0, 4.0, 0.0}, k, c, true}}}).ok());
    ASSERT_FALSE((*solver->advance(5000)).divergence.has_value());
    const State state = *solver->state();
    const double height = 4.0 - m * 9.8 / k;
    EXPECT_NEAR(state.ball_position[0].y, height, 4.0 * eps * height * (1.0 + c / (k * h)))
        << name_of(integrator);
    EXPECT_EQ(state.ball_position[0].x, 1.0);
    EXPECT_EQ(state.ball_angular_velocity[0], (Vec3{1.0, 2.0, 3.0})) << "it acts at the center";
    EXPECT_LT(state.ball_position[1].y, -400.0) << "nobody pulls the other";
  }
}

TEST(PullOnABall, DoesNothingToOneThatWaitsForItsLaunch) {
  ModelSettings settings;
  settings.launchers.emplace_back().count = 3;
  const Model model = test::build(settings);
  auto solver = test::solver_for(model, Precision::double_);
  ASSERT_TRUE(solver->set_inputs({{Pull{2, {0.0, 50.0, 0.0}, 100.0, 1.0, true}}}).ok());
  ASSERT_FALSE((*solver->advance(100)).divergence.has_value());
  EXPECT_EQ(solver->state()->ball_position[2], model.balls[2].initial_position);
  EXPECT_EQ(solver->set_inputs({{Pull{3, {}, 1.0, 1.0, true}}}).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace aspic
