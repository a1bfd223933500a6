// Balls and faces of bodies: rest on coarse ones, none passes, momentum and energy, and where faces do not
// count.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "aspic/analysis.h"
#include "support/epsilon.h"
#include "support/integrator_names.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::after;
using test::build;
using test::eps;

/// A cube of eight particles, 1 m along an edge.
CubeSettings coarse_cube() {
  CubeSettings cube;
  cube.particles_per_edge = 2;
  cube.edge_length = 1.0;
  cube.position = {0.0, 0.5, 0.0};
  cube.particle_mass = 5.0;
  cube.structural = cube.shear = cube.bending = {4000.0, 60.0};
  return cube;
}

/// It stands on its bottom, with a ball above its upper face, whose corners are farther away than R.
ModelSettings ball_on_cube(Integrator integrator, bool held, const Vec3& from) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 1.0 / 240.0;
  settings.contact.ball_restitution = 0.3;
  settings.cubes = {coarse_cube()};
  settings.cubes[0].pinned.names = {"bottom"};
  if (held) settings.cubes[0].pinned.names.push_back("top");
  settings.balls.push_back({0.2, 2.0, from, {}, {}});
  return settings;
}

class BallsOnCoarseFaces : public testing::TestWithParam<Integrator> {
 protected:
  static State after_seconds(double t, bool held, const Vec3& from) {
    const Model model = build(ball_on_cube(GetParam(), held, from));
    return after(model, static_cast<std::uint64_t>(std::lround(t / model.simulation.timestep)));
  }
};

TEST_P(BallsOnCoarseFaces, RestWhereTheseAreHeld) {
  const State end = after_seconds(4.0, true, {0.13, 1.5, -0.21});
  EXPECT_LT(length(end.ball_velocity[0]), 1e-9);
  const Vec3 off = end.ball_position[0] - Vec3{0.13, 1.2, -0.21};
  EXPECT_LT(std::hypot(off.x, off.z), 1e-9);
  // A method that moves with the old velocity stops it where it comes within ε.
  EXPECT_GT(off.y, -1e-9);
  EXPECT_LT(off.y, 0.01);
}

// In the dent that it makes it may rock.
TEST_P(BallsOnCoarseFaces, StayOnSoftOnes) {
  const State end = after_seconds(5.0, false, {0.0, 1.5, 0.0});
  EXPECT_LT(std::abs(end.ball_velocity[0].y), 1e-4);
  EXPECT_LT(length(end.ball_velocity[0]), 1e-2);
  EXPECT_NEAR(end.ball_position[0].y, 1.2, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Integrators, BallsOnCoarseFaces, testing::ValuesIn(all_integrators),
                         test::by_integrator);

TEST(BallFaces, FallThroughWhereTheyDoNotCount) {
  for (const bool course : {false, true}) {
    ModelSettings settings = ball_on_cube(Integrator::symplectic_euler, false, {0.05, 1.5, -0.1});
    if (course)
      settings.contact.model = ContactModel::course;
    else
      settings.contact.bodies = false;
    const State end = after(build(settings), 2000);
    EXPECT_LT(end.ball_position[0].y, 0.6);
  }
}

TEST(BallFaces, HoldABallOnACoarseCloth) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.contact.ball_restitution = 0.3;
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {3, 3};
  cloth.size = {2.0, 2.0};
  cloth.position = {0.0, 1.0, 0.0};
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  cloth.particle_mass = 0.5;
  cloth.structural = cloth.shear = {2000.0, 20.0};
  cloth.bending = {200.0, 5.0};
  for (int i = 0; i < 9; ++i)
    if (i != 4) cloth.pinned.indices.push_back(i);
  settings.balls.push_back({0.15, 0.5, {0.45, 1.6, 0.4}, {}, {}});
  const State end = after(build(settings), 8000);
  // It rolls in it.
  EXPECT_LT(length(end.ball_velocity[0]), 1.0);
  EXPECT_GT(end.ball_position[0].y, 0.6);
  EXPECT_LT(std::hypot(end.ball_position[0].x, end.ball_position[0].z), 1.0);
}

/// A cube alone in space and balls that fly at it from everywhere, at this speed.
ModelSettings bombarded(double speed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto number = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.simulation.gravity = {};
  CubeSettings cube = coarse_cube();
  cube.position = {};
  cube.rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.cubes = {cube};
  for (int b = 0; b < 6; ++b) {
    Vec3 from = {number(), number(), number()};
    from = (1.0 / length(from)) * from;
    const Vec3 aim = 0.25 * Vec3{number(), number(), number()};
    const Vec3 at = (1.6 + 0.5 * b) * from;
    settings.balls.push_back(
        {0.15, 0.5, at, (speed / length(aim - at)) * (aim - at), {9.0 * number(), 9.0 * number(), 0.0}});
  }
  return settings;
}

struct Sums {
  Vec3 momentum;
  double size = 0.0;  ///< Σ m·|v|
};
Sums sums_of(const Model& model, const State& state) {
  Sums sums;
  const auto add = [&](double m, const Vec3& v) {
    sums.momentum = sums.momentum + m * v;
    sums.size += m * length(v);
  };
  for (std::size_t i = 0; i < state.velocity.size(); ++i) add(model.mass[i], state.velocity[i]);
  for (std::size_t b = 0; b < state.ball_velocity.size(); ++b)
    add(model.balls[b].mass, state.ball_velocity[b]);
  return sums;
}

TEST(BallFaces, KeepMomentumAndMakeNoEnergy) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Model model = build(bombarded(6.0, seed));
    const auto solver = std::move(*make_reference_solver(model, Precision::double_));
    const State start = *solver->state();
    const Sums before = sums_of(model, start);
    const double energy = measure(model, start).total();
    bool struck = false;
    for (int n = 0; n < 60; ++n) {
      ASSERT_FALSE((*solver->advance(20)).divergence.has_value());
      const State now = *solver->state();
      const Sums sums = sums_of(model, now);
      EXPECT_LT(length(sums.momentum - before.momentum), 1e4 * eps * before.size);
      EXPECT_LT(measure(model, now).total(), energy * (1.0 + 1e-3));
      for (std::size_t i = 0; i < now.velocity.size(); ++i) struck = struck || length(now.velocity[i]) > 0.3;
    }
    EXPECT_TRUE(struck);
  }
}

// Up to the speed at which a ball's center goes by its radius in a step; a heavier ball than the face may
// push it in before it.
TEST(BallFaces, LetNothingPass) {
  for (const double speed : {5.0, 20.0, 60.0}) {
    for (std::uint64_t seed = 11; seed <= 14; ++seed) {
      ModelSettings settings = bombarded(speed, seed);
      for (int i = 0; i < 8; ++i) settings.cubes[0].pinned.indices.push_back(i);
      const Model model = build(settings);
      const auto solver = std::move(*make_reference_solver(model, Precision::double_));
      const CubeSettings& cube = settings.cubes[0];
      for (int n = 0; n < 400; ++n) {
        ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
        const State now = *solver->state();
        for (const Vec3& x : now.ball_position) {
          // The cube's half edge is 0.5: its inscribed sphere holds no center.
          EXPECT_GT(length(x - cube.position), 0.5) << "at " << speed << " m/s";
        }
      }
    }
  }
}

}  // namespace
}  // namespace aspic
