// The cpu backend ends with the same bits as the reference in single precision: any scene, integrator and
// contact model, any number of threads, any instruction set.
#include "cpu_parallel/cpu_solver.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "cpu_reference/reference_solver.h"
#include "scene/load.h"
#include "support/model_building.h"

namespace aspic {
namespace {

constexpr ContactModel both_models[] = {ContactModel::coulomb, ContactModel::course};

std::unique_ptr<Solver> cpu(const Model& model, unsigned threads = 0) {
  auto solver = make_cpu_solver(model, {threads});
  EXPECT_TRUE(solver.ok());
  return std::move(*solver);
}

std::unique_ptr<Solver> reference(const Model& model) {
  return std::move(*make_reference_solver(model, Precision::single));
}

/// Both advance by `steps`, with the same divergence, if any, and the same state.
void expect_equal(const Model& model, std::uint64_t steps, unsigned threads = 0) {
  const auto expected = reference(model), solver = cpu(model, threads);
  const auto bad = *expected->advance(steps), also_bad = *solver->advance(steps);
  ASSERT_EQ(bad.has_value(), also_bad.has_value());
  if (bad) {
    EXPECT_EQ(bad->step, also_bad->step);
    EXPECT_EQ(bad->particle, also_bad->particle);
    EXPECT_EQ(bad->finite, also_bad->finite);
    EXPECT_EQ(bad->ball, also_bad->ball);
  }
  EXPECT_EQ(*expected->state(), *solver->state());
  EXPECT_EQ(state_hash_text(*expected->state()), state_hash_text(*solver->state()));
}

TEST(CpuSolver, HasTheReferencesBitsInEveryBuiltInScene) {
  for (const char* const name : {"cube-plane", "cube-tilted-plane", "cube-sphere", "cube-bowl", "elevator",
                                 "goal-net", "penalty", "cube-and-balls"}) {
    for (const Integrator integrator : all_integrators) {
      for (const ContactModel contact : both_models) {
        SCOPED_TRACE(fmt::format("{}, {}, {}", name, name_of(integrator), name_of(contact)));
        auto scene = load_scene(name);
        ASSERT_TRUE(scene.ok());
        scene->model.simulation.integrator = integrator;
        scene->model.contact.model = contact;
        for (CubeSettings& cube : scene->model.cubes) cube.position.y -= 4.0;  // contact soon
        expect_equal(test::build(scene->model), row_of(integrator).solved() ? 10 : 300);
      }
    }
  }
}

TEST(CpuSolver, HasTheReferencesBitsOnTerrainThatMovesSideways) {
  for (const Integrator integrator : explicit_integrators) {
    for (const ContactModel contact : both_models) {
      SCOPED_TRACE(fmt::format("{}, {}", name_of(integrator), name_of(contact)));
      ModelSettings settings = test::low_cube(5, integrator, contact);
      settings.terrain[0].motion = TerrainMotion{{1.0, 0.0, 0.4}, 0.3, 1.1, 0.2};
      expect_equal(test::build(settings), 400, 2);
      settings.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
      expect_equal(test::build(settings), 400, 2);
    }
  }
}

// A cube in the air and a wall whose place at rest is 18 m away: it meets the cube after about 40 steps.
TEST(CpuSolver, SeesTerrainThatComesFromFar) {
  for (const Integrator integrator : explicit_integrators) {
    for (const ContactModel contact : both_models) {
      SCOPED_TRACE(fmt::format("{}, {}", name_of(integrator), name_of(contact)));
      ModelSettings settings = test::low_cube(5, integrator, contact);
      settings.cubes[0].position.y = 50.0;
      settings.cubes[0].velocity.x = -1.0;
      settings.terrain.push_back(
          {.geometry = {{"point", Vec3{-20.6, 0.0, 0.0}}, {"normal", Vec3{1.0, 0.0, 0.0}}}});
      const Model still = test::build(settings);
      settings.terrain[1].motion = TerrainMotion{{1.0, 0.0, 0.0}, 18.0, 0.1, 0.23};
      const Model model = test::build(settings);
      expect_equal(model, 400, 2);
      const auto without = reference(still), with = reference(model);
      ASSERT_FALSE((*without->advance(400)).has_value());
      ASSERT_FALSE((*with->advance(400)).has_value());
      EXPECT_FALSE(*without->state() == *with->state()) << "the wall does not reach the cube";
    }
  }
}

TEST(CpuSolver, HasTheReferencesBitsWithAnyNumberOfThreads) {
  for (const Integrator integrator : explicit_integrators) {
    for (const ContactModel contact : both_models) {
      const Model model = test::build(test::low_cube(9, integrator, contact));
      for (const unsigned threads : {1u, 2u, 5u}) {
        SCOPED_TRACE(fmt::format("{}, {}, {} threads", name_of(integrator), name_of(contact), threads));
        expect_equal(model, 400, threads);
      }
    }
  }
}

TEST(CpuSolver, HasTheReferencesBitsWithEveryInstructionSet) {
  ModelSettings settings = test::low_cube(7, Integrator::runge_kutta_4, ContactModel::coulomb);
  settings.goal_nets.emplace_back();
  settings.goal_nets[0].cord = true;
  settings.goal_nets[0].shear.stiffness = settings.goal_nets[0].bending.stiffness = 300.0;
  const Model model = test::build(settings);
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    expect_equal(model, 200, 2);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(CpuSolver, HasTheReferencesBitsForEverySizeOfCube) {
  for (const int n : {2, 3, 4, 5, 6, 8, 16, 17, 33}) {
    SCOPED_TRACE(n);
    expect_equal(test::build(test::low_cube(n, Integrator::symplectic_euler, ContactModel::coulomb)), 30);
  }
}

TEST(CpuSolver, GivesSpringsWithoutLengthNoForce) {
  // All particles in one place: every spring has length 0 until gravity and the pinned ones part them.
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes[0].pinned.names = {"left-top-front"};
  Model model = test::build(settings);
  for (Vec3& x : model.initial_position) x = {0.0, 2.0, 0.0};
  expect_equal(model, 50, 2);
}

TEST(CpuSolver, PullsAsTheReferenceDoes) {
  const Model model = test::build(test::low_cube(6, Integrator::midpoint, ContactModel::course));
  const auto expected = reference(model), solver = cpu(model, 2);
  for (const std::uint32_t particle : {0u, 215u, 100u}) {
    const Pull pull = {particle, {0.3, 4.0, 0.1}, 800.0, 20.0};
    for (Solver* const each : {expected.get(), solver.get()}) {
      ASSERT_TRUE(each->set_pull(pull).ok());
      ASSERT_TRUE(each->advance(60).ok());
    }
    EXPECT_EQ(*expected->state(), *solver->state());
  }
  EXPECT_FALSE(solver->set_pull(Pull{216, {}, 1.0, 1.0}).ok());
}

TEST(CpuSolver, NamesTheSameDivergence) {
  ModelSettings settings = test::low_cube(6, Integrator::explicit_euler, ContactModel::coulomb);
  settings.simulation.timestep = 0.02;
  const Model model = test::build(settings);
  const auto solver = cpu(model, 2);
  const auto divergence = *solver->advance(5000);
  ASSERT_TRUE(divergence.has_value());
  expect_equal(model, 5000, 2);
  // The last good step stays, and the same divergence is reported until a state is loaded.
  EXPECT_EQ((*solver->state()).step + 1, divergence->step);
  EXPECT_EQ((*solver->advance(1))->step, divergence->step);
  ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
  EXPECT_FALSE((*solver->advance(1)).has_value());
}

TEST(CpuSolver, TakesOverAStateInMidRun) {
  const Model model = test::build(test::low_cube(6, Integrator::runge_kutta_4, ContactModel::coulomb));
  const auto first = reference(model), second = cpu(model, 2), complete = reference(model);
  ASSERT_TRUE(first->advance(123).ok());
  ASSERT_TRUE(second->load(*first->state()).ok());
  ASSERT_TRUE(second->advance(200).ok());
  ASSERT_TRUE(complete->advance(323).ok());
  EXPECT_EQ(*second->state(), *complete->state());
}

}  // namespace
}  // namespace aspic
