#include "cpu_reference/reference_solver.h"

#include <gtest/gtest.h>

#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

TEST(ReferenceSolver, StartsAtTheModelsState) {
  const Model model = test::build(test::cube_on_plane(4));
  for (const Precision precision : {Precision::single, Precision::double_}) {
    auto solver = test::solver_for(model, precision);
    EXPECT_EQ(*solver->state(), initial_state(model, precision));
  }
}

TEST(ReferenceSolver, SplittingARunChangesNoBit) {
  ModelSettings settings = test::cube_on_plane(4, 1.5);
  settings.cubes[0].rotation = {{1, 2, 3}, 20};
  const Model model = test::build(settings);
  auto whole = test::solver_for(model, Precision::single), split = test::solver_for(model, Precision::single);
  ASSERT_FALSE((*whole->advance(700)).divergence.has_value());
  ASSERT_FALSE((*split->advance(123)).divergence.has_value());
  const State middle = *split->state();
  auto resumed = test::solver_for(model, Precision::single);
  ASSERT_TRUE(resumed->load(middle).ok());
  ASSERT_FALSE((*resumed->advance(577)).divergence.has_value());
  EXPECT_EQ(state_hash(*resumed->state()), state_hash(*whole->state()));
  EXPECT_EQ(resumed->state()->step, 700u);
}

TEST(ReferenceSolver, DivergenceKeepsTheLastGoodState) {
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes[0].velocity = {0.1, 0, 0};
  settings.cubes[0].rotation = {{1, 2, 3}, 20};
  settings.simulation.timestep = 0.05;
  const Model model = test::build(settings);
  auto solver = test::solver_for(model, Precision::single);
  const auto divergence = solver->advance(100000)->divergence;
  ASSERT_TRUE(divergence.has_value());
  const State last = *solver->state();
  EXPECT_EQ(last.step + 1, divergence->step);
  for (const Vec3& v : last.velocity) EXPECT_LE(length(v), divergence_speed * (1 + 1e-6));
  // It stays there, and says the same again.
  EXPECT_EQ((*solver->advance(10)).divergence->step, divergence->step);
  EXPECT_EQ(*solver->state(), last);
  // Loading a state clears it.
  ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
  EXPECT_FALSE((*solver->advance(1)).divergence.has_value());
}

TEST(ReferenceSolver, TooFastIsDivergenceAndNamesTheLowestParticle) {
  const Model model =
      test::particles({{0, 0, 0}, {5, 0, 0}, {9, 0, 0}}, {{0, 0, 0}, {1001, 0, 0}, {2000, 0, 0}});
  const auto divergence = test::solver_for(model, Precision::single)->advance(1)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_EQ(divergence->particle, 1u);
  EXPECT_EQ(divergence->step, 1u);
  EXPECT_TRUE(divergence->finite);
}

// Springs of 1e12 N/m between particles of 1.9e-38 kg: rounding alone makes forces that no single-precision
// acceleration can hold, so that the first residual is infinite and no iterate is better.
TEST(ReferenceSolver, ASolveWhoseResidualIsNotFiniteIsDivergence) {
  ModelSettings settings = test::cube_on_plane(3);
  settings.terrain.clear();  // with the ground in the equation the solve takes steps that raise the residual
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.cubes[0].particle_mass = 1.9e-38;
  settings.cubes[0].structural.stiffness = 1e12;
  settings.cubes[0].rotation = {{1, 2, 3}, 20};
  const Model model = test::build(settings);
  auto solver = test::solver_for(model, Precision::single);
  const auto divergence = solver->advance(10)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_TRUE(divergence->residual);
  EXPECT_FALSE(divergence->finite);
  EXPECT_EQ(body_text(*divergence), "the residual of the implicit solve");
  EXPECT_EQ(divergence->step, 1u);
  EXPECT_EQ(*solver->state(), initial_state(model, Precision::single));
  EXPECT_EQ(solver->solve_statistics()->steps, 0u);
  EXPECT_EQ(solver->solve_statistics()->worst_residual, 0.0);
}

// |ω| = 1e160 rad/s is a number; its square is none, and no energy could be told.
TEST(ReferenceSolver, SpinWithoutAFiniteEnergyIsDivergence) {
  ModelSettings settings;
  settings.balls.emplace_back();
  const Model model = test::build(settings);
  auto solver = test::solver_for(model, Precision::double_);
  State state = *solver->state();
  state.ball_angular_velocity[0] = {0.0, 1e160, 0.0};
  ASSERT_TRUE(solver->load(state).ok());
  const auto divergence = solver->advance(1)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_TRUE(divergence->ball);
  EXPECT_FALSE(divergence->finite);
}

TEST(ReferenceSolver, PinnedParticlesStay) {
  ModelSettings settings = test::cube_on_plane(4, 3.0);
  settings.cubes[0].pinned.names = {"top"};
  const Model model = test::build(settings);
  for (const Integrator integrator : {Integrator::explicit_euler, Integrator::runge_kutta_4}) {
    Model copy = model;
    copy.simulation.integrator = integrator;
    auto solver = test::solver_for(copy, Precision::single);
    ASSERT_FALSE((*solver->advance(500)).divergence.has_value());
    const State start = initial_state(copy, Precision::single), end = *solver->state();
    for (std::uint32_t i = 0; i < copy.particle_count(); ++i) {
      if (copy.inverse_mass[i] == 0.0) {
        EXPECT_EQ(end.position[i], start.position[i]);
        EXPECT_EQ(end.velocity[i], Vec3{});
      } else {
        EXPECT_NE(end.position[i], start.position[i]);
      }
    }
  }
}

TEST(ReferenceSolver, RefusesAnotherScenesState) {
  const Model model = test::build(test::cube_on_plane(4));
  auto solver = test::solver_for(model, Precision::single);
  EXPECT_EQ(solver->load(State{}).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace aspic
