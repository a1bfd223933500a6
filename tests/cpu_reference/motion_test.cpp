// Terrain that moves: the pose, and bodies on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"
#include "model/terrain.h"
#include "support/epsilon.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using test::eps;

TEST(Pose, IsASineOfTimeAndItsDerivative) {
  const TerrainMotion motion = {{0.6, 0.8, 0.0}, 2.0, 0.3, 0.1};
  constexpr double h = 1e-3, turn = 2.0 * std::numbers::pi;
  for (const std::uint64_t step : {0u, 1u, 777u, 123456u}) {
    const Pose now = pose_at(motion, h, step);
    const double angle = turn * (0.3 * h * static_cast<double>(step) + 0.1);
    EXPECT_LT(length(now.offset - 2.0 * std::sin(angle) * motion.direction), 8 * eps * (1.0 + angle));
    const Vec3 change = pose_at(motion, h, step + 1).offset -
                        (step ? pose_at(motion, h, step - 1).offset
                              : 2.0 * std::sin(turn * (0.1 - 0.3 * h)) * motion.direction);
    // A central difference is off by h²/6 of the third derivative, 2·(2π·0.3)³, and by rounding over h.
    EXPECT_LT(length((0.5 / h) * change - now.velocity), h * h * 2.3 + 16 * eps * (1.0 + angle) / h);
  }
}

TEST(Pose, DisplacesPlacesAndNoDirections) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    const Terrain still =
        make_terrain({.shape = row.value, .motion = TerrainMotion{{0, 3, 4}, 1.5, 1.0, 0.25}}, {});
    const Terrain moved = terrain_at(still, 0.25, 4);  // a whole turn: at the top again
    const Vec3 offset = {0.0, 0.9, 1.2};
    EXPECT_NEAR(signed_distance(moved, row.drop + offset), signed_distance(still, row.drop),
                16 * eps * (extent(still) + 1.5))
        << row.name;
    EXPECT_EQ(terrain_at(make_terrain({.shape = row.value}, {}), 0.25, 4).geometry.vectors,
              make_terrain({.shape = row.value}, {}).geometry.vectors);
  }
}

class Moving : public ::testing::TestWithParam<Integrator> {
 protected:
  double h = GetParam() == Integrator::implicit_euler ? 1.0 / 60 : 1e-3;

  Model particle_on(const TerrainMotion& motion, double friction = 0.3) {
    Model model = test::particles({{0, 0, 0}}, {{0, 0, 0}});
    model.simulation.integrator = GetParam();
    model.simulation.timestep = h;
    model.simulation.implicit.tolerance = 1e-14;
    TerrainSettings ground = {.geometry = {{"point", Vec3{0, 0, 0}}}, .friction = friction, .motion = motion};
    model.terrain.push_back(make_terrain(ground, model.contact));
    const Pose start = pose_at(model.terrain[0].motion.value(), h, 0);
    model.initial_position.set(0, start.offset);
    model.initial_velocity.set(0, start.velocity);
    return model;
  }
  std::uint64_t steps(double seconds) const { return static_cast<std::uint64_t>(std::lround(seconds / h)); }
};

INSTANTIATE_TEST_SUITE_P(Integrators, Moving, ::testing::ValuesIn(all_integrators), [](const auto& instance) {
  std::string name(name_of(instance.param));
  std::ranges::replace(name, '-', '_');
  return name;
});

// The plane's acceleration stays below gravity's: the particle never leaves it. In a step the ground moves by
// its mean velocity and the particle by that of the step's end, a difference of ½h²a, which the next step
// takes back.
TEST_P(Moving, AnElevatorCarriesAParticleAndNeverLosesIt) {
  const TerrainMotion motion = {{0, 1, 0}, 1.0, 0.25, 0.1};
  const double a = std::pow(2 * std::numbers::pi * 0.25, 2);
  const Model model = particle_on(motion);
  const auto solver = std::move(make_reference_solver(model, Precision::double_)).value();
  for (std::uint64_t step = 1; step <= steps(8.0); ++step) {
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const State now = *solver->state();
    const double d = signed_distance(terrain_at(model.terrain[0], h, step), now.position[0]);
    ASSERT_GE(d, -16 * eps) << "step " << step;
    ASSERT_LE(d, 2 * h * h * a) << "step " << step;
    ASSERT_LE(std::abs(now.velocity[0].y - pose_at(motion, h, step).velocity.y), 2 * h * a + 1e-12)
        << "step " << step;
  }
}

// Friction holds a particle on a shaking plate of less than μg, with both components of its velocity.
TEST_P(Moving, AShakingPlateCarriesAParticleAlong) {
  const TerrainMotion motion = {{1, 0, 0}, 0.5, 0.25, 0.0};
  const double a = 0.5 * std::pow(2 * std::numbers::pi * 0.25, 2);
  ASSERT_LT(a, 0.3 * 9.8);
  const Model model = particle_on(motion);
  const auto solver = std::move(make_reference_solver(model, Precision::double_)).value();
  for (std::uint64_t step = 1; step <= steps(8.0); ++step) {
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const State now = *solver->state();
    const Pose pose = pose_at(motion, h, step);
    // Sums of the velocity over steps are off the sine by half a step's change at most.
    ASSERT_NEAR(now.position[0].x, pose.offset.x, 1.05 * h * 0.5 * 2 * std::numbers::pi * 0.25)
        << "step " << step;
    ASSERT_NEAR(now.velocity[0].x, pose.velocity.x, 1e-9) << "step " << step;
  }
}

// A plate that shakes harder slips below it: friction moves the particle by no more than μg.
TEST_P(Moving, APlateThatShakesHarderThanFrictionHoldsSlips) {
  const TerrainMotion motion = {{1, 0, 0}, 0.5, 1.0, 0.0};
  const Model model = particle_on(motion, 0.1);
  const auto solver = std::move(make_reference_solver(model, Precision::double_)).value();
  Vec3 before = model.initial_velocity[0];
  double most = 0.0, lag = 0.0;
  for (std::uint64_t step = 1; step <= steps(3.0); ++step) {
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const State now = *solver->state();
    most = std::max(most, std::abs(now.velocity[0].x - before.x) / h);
    lag = std::max(lag, std::abs(now.velocity[0].x - pose_at(motion, h, step).velocity.x));
    before = now.velocity[0];
  }
  EXPECT_NEAR(most, 0.1 * 9.8, 0.01 * 9.8 * 0.1);
  EXPECT_GT(lag, 1.0) << "the plate's speed reaches 3.1 m/s";
}

// The ground's velocity counts in the bounce: a racket of infinite mass that meets a particle at −V.
TEST_P(Moving, ARacketAddsTwiceItsSpeed) {
  Model model = particle_on({{0, 1, 0}, 1.0, 0.25, 0.0});
  model.simulation.gravity = {0, 0, 0};
  model.terrain[0].restitution = 1.0;
  model.initial_position.set(0, {0, 0.05, 0});
  model.initial_velocity.set(0, {0, -3.0, 0});
  const auto solver = std::move(make_reference_solver(model, Precision::double_)).value();
  ASSERT_FALSE((*solver->advance(steps(0.1))).divergence.has_value());
  // V = 2π·0.25·cos(…) changes by less than A·ω²·0.1 s · ½ until the impact, and by the step's length.
  const double V = 2 * std::numbers::pi * 0.25;
  EXPECT_NEAR((*solver->state()).velocity[0].y, 3.0 + 2 * V, 2 * V * (1 - std::cos(V * (0.02 + h))) + 1e-9);
}

TEST_P(Moving, ARunTakenUpInItsMiddleEndsWithTheSameBits) {
  ModelSettings settings = test::cube_on_plane(3, 2.0);
  settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.simulation.integrator = GetParam();
  settings.simulation.timestep = h;
  settings.terrain[0].motion = TerrainMotion{{0.2, 1.0, 0.1}, 0.4, 0.7, 0.3};
  const Model model = test::build(settings);
  const auto at_once = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*at_once->advance(300)).divergence.has_value());
  const auto first = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*first->advance(170)).divergence.has_value());
  const auto second = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_TRUE(second->load(*first->state()).ok());
  ASSERT_FALSE((*second->advance(130)).divergence.has_value());
  EXPECT_EQ(*second->state(), *at_once->state());
}

// Motion of no amplitude is where it is without any, and changes no number of a run.
TEST_P(Moving, NoAmplitudeMovesNothing) {
  ModelSettings settings = test::cube_on_plane(3, 1.6);
  settings.simulation.integrator = GetParam();
  settings.simulation.timestep = h;
  const Model still = test::build(settings);
  settings.terrain[0].motion = TerrainMotion{{0.0, 1.0, 0.0}, 0.0, 0.25, 0.0};
  const Model moving = test::build(settings);
  const auto a = std::move(make_reference_solver(still, Precision::single)).value();
  const auto b = std::move(make_reference_solver(moving, Precision::single)).value();
  ASSERT_FALSE((*a->advance(200)).divergence.has_value());
  ASSERT_FALSE((*b->advance(200)).divergence.has_value());
  const State end = *a->state(), same = *b->state();
  for (std::size_t i = 0; i < end.position.size(); ++i) {
    EXPECT_EQ(end.position[i], same.position[i]);
    EXPECT_EQ(end.velocity[i], same.velocity[i]);
  }
}

// A ball of radius R lies on the elevator, its center R above it.
TEST_P(Moving, AnElevatorCarriesABall) {
  ModelSettings settings;
  settings.simulation.integrator = GetParam();
  settings.simulation.timestep = h;
  settings.terrain.push_back(
      {.geometry = {{"point", Vec3{0, 0, 0}}}, .motion = TerrainMotion{{0, 1, 0}, 1.0, 0.25, 0.25}});
  settings.balls.push_back({0.3, 1.0, {0, 1.3, 0}, {0, 0, 0}, {0, 0, 0}});
  const Model model = test::build(settings);
  const double a = std::pow(2 * std::numbers::pi * 0.25, 2);
  const auto solver = std::move(make_reference_solver(model, Precision::double_)).value();
  for (std::uint64_t step = 1; step <= steps(8.0); ++step) {
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const double d =
        signed_distance(terrain_at(model.terrain[0], h, step), (*solver->state()).ball_position[0]) - 0.3;
    ASSERT_GE(d, -16 * eps) << "step " << step;
    ASSERT_LE(d, 2 * h * h * a) << "step " << step;
  }
}

}  // namespace
}  // namespace aspic
