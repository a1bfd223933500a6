// Balls on terrain: they slide, roll, bounce and come to rest.
#include <gtest/gtest.h>

#include <cmath>

#include "model/integrator.h"
#include "support/epsilon.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::after;
using test::expect_near;
using test::solver_for;
using test::weightless;

using test::eps;

/// A ball at rest on a slope of 30° that falls towards +x.
ModelSettings on_slope(double friction) {
  ModelSettings settings;
  const double s = 0.5, c = std::sqrt(3.0) / 2.0;
  settings.terrain.emplace_back();
  settings.terrain[0].geometry["point"] = Vec3{};
  settings.terrain[0].geometry["normal"] = Vec3{s, c, 0.0};
  settings.terrain[0].friction = friction;
  settings.balls.push_back({0.4, 2.5, {0.4 * s, 0.4 * c, 0.0}, {}, {}});
  return settings;
}

TEST(BallsOnTheGround, SlideWithoutFrictionAndRollAtFiveSeventhsWithEnough) {
  const double h = 0.001, along = 9.8 * 0.5;
  const std::uint64_t steps = 1000;
  // Each step adds h·g, takes the normal part away and, with friction, the slip: the sum is exact but for
  // rounding of speeds up to 5 m/s in every step.
  const double tolerance = static_cast<double>(steps) * 16 * eps * 5.0;
  const State slid = after(test::build(on_slope(0.0)), steps);
  EXPECT_NEAR(length(slid.ball_velocity[0]), static_cast<double>(steps) * h * along, tolerance);
  EXPECT_EQ(slid.ball_angular_velocity[0], Vec3{});

  // Rolling needs μ ≥ 2/7·tan 30° = 0.165.
  const State rolled = after(test::build(on_slope(0.2)), steps);
  const double speed = length(rolled.ball_velocity[0]);
  EXPECT_NEAR(speed, static_cast<double>(steps) * h * along * 5.0 / 7.0, tolerance);
  EXPECT_NEAR(rolled.ball_angular_velocity[0].z, -speed / 0.4, tolerance / 0.4);

  // With less it slides on: a = g(sin θ − μ cos θ), and friction turns it at μ·m·g·cos θ·R/I.
  const double mu = 0.1, normal = 9.8 * std::sqrt(3.0) / 2.0;
  const State skidded = after(test::build(on_slope(mu)), steps);
  EXPECT_NEAR(length(skidded.ball_velocity[0]), static_cast<double>(steps) * h * (along - mu * normal),
              tolerance);
  EXPECT_NEAR(skidded.ball_angular_velocity[0].z, -static_cast<double>(steps) * h * 2.5 * mu * normal / 0.4,
              10 * tolerance);
}

TEST(BallsOnTheGround, WithoutSpinAreParticlesOfTheirRadius) {
  ModelSettings settings = on_slope(0.7);  // μ > tan 30°: a particle sticks
  settings.contact.spin = false;
  const Model model = test::build(settings);
  const State end = after(model, 500);
  expect_near(end.ball_position[0], initial_state(model, Precision::double_).ball_position[0], 4 * eps * 0.4);
  // It is let down by what rounding leaves between it and the surface.
  expect_near(end.ball_velocity[0], Vec3{}, 4 * eps * 0.4 / model.simulation.timestep);
  EXPECT_EQ(end.ball_angular_velocity[0], Vec3{});
}

// Spin about z meets level ground: the slip R·ω x̂ ends, 2/7 of it in the velocity, 5/7 in the rotation, if
// friction suffices; else the friction impulse is μ(1 + e)m|u|.
TEST(BallsOnTheGround, SpinTurnsABounce) {
  for (const double mu : {0.02, 5.0}) {
    ModelSettings settings = weightless();
    settings.contact.spin = true;
    settings.terrain.emplace_back();
    settings.terrain[0].friction = mu;
    settings.terrain[0].restitution = 0.5;
    const double R = 0.3, omega = 20.0, fall = 4.0;
    settings.balls.push_back({R, 2.0, {0.0, -1.0 + R + 0.002, 0.0}, {0.0, -fall, 0.0}, {0.0, 0.0, omega}});
    const Model model = test::build(settings);
    const State end = after(model, 1);
    const double taken = std::min(2.0 / 7.0 * R * omega, mu * 1.5 * fall);
    // The bounce takes the speed from positions of up to 1 m, a step apart; friction takes up to μ times
    // that.
    const double rounding = 64 * eps * 8.0 + (1.0 + mu) * 4 * eps / model.simulation.timestep;
    expect_near(end.ball_velocity[0], {-taken, 0.5 * fall, 0.0}, rounding);
    expect_near(end.ball_angular_velocity[0], {0.0, 0.0, omega - 2.5 * taken / R}, 5.0 * rounding / R);
  }
}

// A ball dropped from 1 m: its first apex is e² of that, then it comes to rest and stays there to the bit.
TEST(BallsOnTheGround, BounceByRestitutionAndComeToRest) {
  for (const Integrator integrator : all_integrators) {
    for (const bool spin : {true, false}) {
      ModelSettings settings;
      settings.simulation.integrator = integrator;
      settings.contact.spin = spin;
      settings.terrain.emplace_back();
      settings.terrain[0].geometry["point"] = Vec3{};
      settings.terrain[0].restitution = 0.7;
      const double R = 0.25;
      settings.balls.push_back({R, 2.0, {0.0, 1.0 + R, 0.0}, {}, {}});
      const Model model = test::build(settings);
      auto solver = solver_for(model);
      ASSERT_FALSE((*solver->advance(470)).divergence.has_value());  // the fall takes 452 steps
      double apex = 0.0;
      for (int n = 0; n < 500; ++n) {
        ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
        apex = std::max(apex, solver->state()->ball_position[0].y - R);
      }
      EXPECT_NEAR(apex / 0.49, 1.0, 1e-4) << name_of(integrator) << ", spin " << spin;
      ASSERT_FALSE((*solver->advance(6000)).divergence.has_value());
      const State rested = *solver->state();
      EXPECT_EQ(rested.ball_velocity[0], Vec3{}) << name_of(integrator) << ", spin " << spin;
      EXPECT_NEAR(rested.ball_position[0].y, R, 4 * eps);
      ASSERT_FALSE((*solver->advance(100)).divergence.has_value());
      EXPECT_EQ(solver->state()->ball_position[0], rested.ball_position[0]);
    }
  }
}

// The reaction inside the step holds no friction against rolling: on level ground nothing slows it, on a
// slope it gains 5/7·g·sin θ, as if the ground acted at the steps' ends alone.
TEST(BallsOnTheGround, RollOnUnderEveryIntegrator) {
  const double R = 0.4, along = 9.8 * 0.5, t = 1.0;
  const double rounding = 1000 * 16 * eps * 5.0;
  for (const Integrator integrator : all_integrators) {
    ModelSettings level;
    level.simulation.integrator = integrator;
    level.terrain.emplace_back();
    level.balls.push_back({R, 2.5, {0.0, -1.0 + R, 0.0}, {1.5, 0.0, 0.0}, {0.0, 0.0, -1.5 / R}});
    const State rolled = after(test::build(level), 1000);
    expect_near(rolled.ball_velocity[0], {1.5, 0.0, 0.0}, rounding);
    expect_near(rolled.ball_angular_velocity[0], {0.0, 0.0, -1.5 / R}, rounding / R);
    EXPECT_NEAR(rolled.ball_position[0].x, 1.5 * t, rounding);

    ModelSettings slope = on_slope(0.2);
    slope.simulation.integrator = integrator;
    const State down = after(test::build(slope), 1000);
    EXPECT_NEAR(length(down.ball_velocity[0]), t * along * 5.0 / 7.0, rounding);
    EXPECT_NEAR(down.ball_angular_velocity[0].z, -t * along * 5.0 / 7.0 / R, rounding / R);
  }
}

// A groove that leads down to a wall; friction ends every rotation there.
TEST(BallsOnTheGround, RestBetweenTwoSlopesAndAWall) {
  for (const bool spin : {true, false}) {
    ModelSettings settings;
    settings.contact.spin = spin;
    const Vec3 normals[] = {{0.6, 0.8, 0.0}, {-0.8, 0.6, -0.1}, {0.0, 0.1, 1.0}};
    for (const Vec3& n : normals) {
      settings.terrain.emplace_back();
      settings.terrain.back().geometry["point"] = Vec3{};
      settings.terrain.back().geometry["normal"] = n;
      settings.terrain.back().restitution = 0.3;
    }
    settings.balls.push_back({0.3, 2.0, {0.2, 1.0, 0.6}, {0.2, 0.0, -0.5}, {3.0, 1.0, -2.0}});
    const Model model = test::build(settings);
    const State end = after(model, 8000);
    EXPECT_LT(length(end.ball_velocity[0]), 1e-6) << "spin " << spin;
    for (const Terrain& side : {model.terrain[0], model.terrain[1]})
      EXPECT_NEAR(dot(end.ball_position[0], side.geometry.vectors[1]), 0.3, 1e-5);
  }
}

TEST(BallsOnTheGround, CourseModelBouncesByTheSlidesFormula) {
  ModelSettings settings = weightless();
  settings.contact.model = ContactModel::course;
  settings.terrain.emplace_back();
  settings.terrain[0].mass = 10.0;
  settings.terrain[0].restitution = 1.0;
  settings.balls.push_back({0.3, 1.0, {0.0, -0.7 + 0.005, 0.0}, {1.0, -2.0, 0.0}, {}});
  const State end = after(test::build(settings), 1);
  expect_near(end.ball_velocity[0], {1.0, 18.0 / 11.0, 0.0}, 64 * eps);
}

}  // namespace
}  // namespace aspic
