#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/layout.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"

namespace aspic {
namespace {

class GpuSolverTest : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, ForcePath path = ForcePath::gather) {
    GpuOptions options;
    options.force_path = path;
    auto made = make_gpu_solver(context(), model, options);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    return std::move(made).value();
  }
};

TEST_F(GpuSolverTest, StartsAtTheModelsState) {
  const Model model = test::build(test::cube_on_plane(4));
  EXPECT_EQ(*solver_for(model)->state(), initial_state(model, Precision::single));
}

TEST_F(GpuSolverTest, AutomaticPathIsNamed) {
  const Model model = test::build(test::cube_on_plane(3));
  EXPECT_EQ(solver_for(model, ForcePath::automatic)->force_path(), ForcePath::gather);
  EXPECT_NE(solver_for(model)->description().find("gather"), std::string::npos);
}

TEST_F(GpuSolverTest, SplittingARunChangesNoBit) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.cubes[0].rotation = {{1, 2, 3}, 20};
  settings.simulation.integrator = Integrator::runge_kutta_4;
  const Model model = test::build(settings);
  auto whole = solver_for(model), split = solver_for(model);
  ASSERT_FALSE((*whole->advance(700)).has_value());
  ASSERT_FALSE((*split->advance(1)).has_value());
  ASSERT_FALSE((*split->advance(300)).has_value());
  auto resumed = solver_for(model, ForcePath::per_spring);
  ASSERT_TRUE(resumed->load(*split->state()).ok());
  ASSERT_FALSE((*resumed->advance(399)).has_value());
  EXPECT_EQ(*resumed->state(), *whole->state());
  EXPECT_EQ(resumed->state()->step, 700u);
}

// However many steps were queued behind it, the device stops at the last good state, at the same step and
// particle as the reference, with the same bits, on both paths, for methods of one, two and four stages.
TEST_F(GpuSolverTest, DivergenceIsFoundOnTheDeviceWhereTheReferenceFindsIt) {
  for (const Integrator integrator :
       {Integrator::explicit_euler, Integrator::midpoint, Integrator::runge_kutta_4}) {
    ModelSettings settings = test::cube_on_plane(4, 1.2);
    settings.cubes[0].rotation = {{1, 2, 3}, 20};
    settings.simulation.timestep = 0.02;
    settings.simulation.integrator = integrator;
    const Model model = test::build(settings);
    auto reference = std::move(make_reference_solver(model, Precision::single)).value();
    const auto expected = *reference->advance(100000);
    ASSERT_TRUE(expected.has_value());
    for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
      auto solver = solver_for(model, path);
      const auto found = *solver->advance(100000);
      ASSERT_TRUE(found.has_value());
      EXPECT_EQ(found->step, expected->step);
      EXPECT_EQ(found->particle, expected->particle);
      EXPECT_EQ(found->finite, expected->finite);
      EXPECT_EQ(*solver->state(), *reference->state());
      EXPECT_EQ((*solver->advance(5))->step, expected->step);
      ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
      EXPECT_FALSE((*solver->advance(1)).has_value());
    }
  }
}

TEST_F(GpuSolverTest, NotANumberIsDivergenceAtTheLowestParticle) {
  const Model model = test::build(test::cube_on_plane(4));
  State state = initial_state(model, Precision::single);
  state.velocity[40].x = std::numeric_limits<double>::quiet_NaN();
  auto solver = solver_for(model);
  ASSERT_TRUE(solver->load(state).ok());
  const auto found = *solver->advance(1);
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_TRUE(reference->load(state).ok());
  const auto expected = *reference->advance(1);
  ASSERT_TRUE(found && expected);
  EXPECT_EQ(found->particle, expected->particle);
  EXPECT_FALSE(found->finite);
  EXPECT_FALSE(expected->finite);
}

TEST_F(GpuSolverTest, HoldsAsManyBytesAsItSaid) {
  const Model model = test::build(test::cube_on_plane(6));
  for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
    EXPECT_EQ(solver_for(model, path)->bytes(), gpu_bytes(count(model), Integrator::explicit_euler, path));
  }
  Model implicit = model;
  implicit.simulation.integrator = Integrator::implicit_euler;
  EXPECT_EQ(solver_for(implicit)->bytes(),
            gpu_bytes(count(model), Integrator::implicit_euler, ForcePath::gather));
}

TEST_F(GpuSolverTest, RefusesWhatIsNotBuilt) {
  Model model = test::build(test::cube_on_plane(3));
  GpuOptions options;
  options.force_path = ForcePath::lattice;
  EXPECT_EQ(make_gpu_solver(context(), model, options).error().code, ErrorCode::scene_rejected);
  model.simulation.integrator = Integrator::implicit_euler;
  options.force_path = ForcePath::per_spring;
  EXPECT_EQ(make_gpu_solver(context(), model, options).error().code, ErrorCode::scene_rejected);
}

TEST_F(GpuSolverTest, RefusesAnotherScenesState) {
  const Model model = test::build(test::cube_on_plane(3));
  EXPECT_EQ(solver_for(model)->load(State{}).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace aspic
