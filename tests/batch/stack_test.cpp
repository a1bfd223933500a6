// Every lane of a stack ends with the bits of the reference, whatever is in the others.
#include "cpu_parallel/stack.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <utility>

#include "cpu_reference/reference_solver.h"
#include "support/golden_runs.h"
#include "support/integrator_names.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using parallel::Stack;

/// The same springs somewhere else, in another field, of other stiffness.
Model other_than(Model model) {
  model.simulation.gravity = {0.3, -4.0, 0.1};
  for (SpringClass& spring : model.spring_classes) spring.stiffness *= 1.25;
  model.initial_velocity.assign(model.particle_count(), {0.4, -0.7, 0.1});
  return model;
}

State state_of(const Stack& stack, std::size_t lane) {
  State state;
  resize(state, stack.model(lane)->particle_count(), 0);
  const ConstStateView from = stack.view(lane);
  const StateView to = view_of(state);
  for (std::size_t n = 0; n < from.size(); ++n) copy_vectors(from[n], to[n]);
  state.step = stack.step(lane);
  return state;
}

Stack stack_of(const std::vector<Model>& models) {
  std::vector<SharedModel> all;
  for (const Model& model : models) all.push_back(shared(model));
  return Stack(all, std::make_shared<const parallel::UpperEnds>(models.front()));
}

void expect_reference(const Stack& stack, std::size_t lane, std::uint64_t steps) {
  const auto expected = *make_reference_solver(*stack.model(lane), Precision::single);
  ASSERT_TRUE(expected->advance(steps).ok());
  EXPECT_EQ(state_of(stack, lane), *expected->state());
}

class EveryMethodInAStack : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Stack, EveryMethodInAStack, testing::ValuesIn(explicit_integrators),
                         test::by_integrator);

TEST_P(EveryMethodInAStack, HasTheReferencesBitsInTheCoveringSet) {
  std::size_t runs = 0;
  for (const test::EqualityCase& row : test::covering_cases()) {
    if (row.integrator != GetParam()) continue;
    const test::GoldenRun run = test::golden_run(row);
    const Model model = run.model();
    if (!Stack::takes(model)) continue;
    SCOPED_TRACE(run.scene);
    Stack stack = stack_of({other_than(model), model});
    for (std::uint64_t n = 0; n < run.steps; ++n) stack.advance();
    test::expect_golden(run, state_of(stack, 1));
    ++runs;
  }
  EXPECT_GT(runs, 0u);
}

TEST_P(EveryMethodInAStack, HasTheReferencesBitsOnTerrainThatMovesSideways) {
  for (const ContactModel contact : {ContactModel::coulomb, ContactModel::course}) {
    SCOPED_TRACE(name_of(contact));
    ModelSettings settings = test::low_cube(4, GetParam(), contact);
    settings.terrain[0].motion = TerrainMotion{{1.0, 0.0, 0.4}, 0.3, 1.1, 0.2};
    test::resist(settings, 0.4);
    settings.terrain.push_back(
        {.geometry = {{"point", Vec3{2.6, 0.0, 0.0}}, {"normal", Vec3{-1.0, 0.2, 0.0}}}});
    const Model model = test::build(settings);
    Stack stack = stack_of({model, other_than(model)});
    for (int n = 0; n < 400; ++n) stack.advance();
    for (const std::size_t lane : {0u, 1u}) expect_reference(stack, lane, 400);
  }
}

TEST(Stack, HasTheReferencesBitsWithEveryInstructionSet) {
  // A cube and a goal net of cords, in lattices and in lists.
  ModelSettings settings = test::low_cube(5, Integrator::runge_kutta_4, ContactModel::coulomb);
  settings.goal_nets.emplace_back();
  settings.goal_nets[0].cord = true;
  settings.goal_nets[0].particles = {4, 5, 7};
  settings.contact.bodies = false;  // stacks know nothing of bodies that touch
  const Model model = test::build(settings);
  ASSERT_TRUE(Stack::takes(model));
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    Stack stack = stack_of({model, other_than(model), model, other_than(other_than(model))});
    for (int n = 0; n < 150; ++n) stack.advance();
    expect_reference(stack, 1, 150);
    expect_reference(stack, 2, 150);
    expect_reference(stack, 3, 150);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Stack, GivesSpringsWithoutLengthNoForce) {
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes[0].pinned.names = {"left-top-front"};
  Model model = test::build(settings);
  const Model apart = model;
  model.initial_position = std::vector<Vec3>(model.particle_count(), {0.0, 2.0, 0.0});
  Stack stack = stack_of({apart, model});
  for (int n = 0; n < 50; ++n) stack.advance();
  for (const std::size_t lane : {0u, 1u}) expect_reference(stack, lane, 50);
}

TEST(Stack, TakesSmallExplicitModelsWithoutBalls) {
  ModelSettings settings = test::low_cube(4, Integrator::midpoint, ContactModel::coulomb);
  const Model model = test::build(settings);
  EXPECT_TRUE(Stack::takes(model));
  EXPECT_TRUE(Stack::same(model, other_than(model)));
  Model slower = model;
  slower.simulation.timestep /= 2.0;
  EXPECT_FALSE(Stack::same(model, slower));
  EXPECT_FALSE(Stack::takes(test::build(test::low_cube(13, Integrator::midpoint, ContactModel::coulomb))));
  EXPECT_FALSE(
      Stack::takes(test::build(test::low_cube(4, Integrator::implicit_euler, ContactModel::coulomb))));
  EXPECT_FALSE(Stack::takes(test::build({})));
  settings.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
  EXPECT_FALSE(Stack::takes(test::build(settings)));
}

}  // namespace
}  // namespace aspic
