#include <gtest/gtest.h>

#include "cpu_reference/reference_solver.h"
#include "gpu/program.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/layout.h"
#include "model/springs.h"
#include "support/gl_fixture.h"
#include "support/lattice_bodies.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

class GpuSolverTest : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, ForcePath path = ForcePath::gather) {
    GpuOptions options;
    options.force_path = path;
    return test::value_of(make_gpu_solver(context(), model, options));
  }
};

TEST_F(GpuSolverTest, StartsAtTheModelsState) {
  const Model model = test::build(test::cube_on_plane(4));
  EXPECT_EQ(*solver_for(model)->state(), initial_state(model, Precision::single));
}

TEST_F(GpuSolverTest, AutomaticPathIsNamed) {
  const Model model = test::build(test::cube_on_plane(3));
  EXPECT_EQ(solver_for(model, ForcePath::automatic)->force_path(), ForcePath::lattice);
  EXPECT_NE(solver_for(model)->description().find("gather"), std::string::npos);
  Model listed = model;
  list_springs(listed);
  EXPECT_EQ(solver_for(listed, ForcePath::automatic)->force_path(), ForcePath::gather);
  const Model cells = test::with_cells(test::cube_on_plane(2), test::lattice_of("xx,x."));
  EXPECT_EQ(solver_for(cells, ForcePath::automatic)->force_path(), ForcePath::lattice);
}

TEST_F(GpuSolverTest, SplittingARunChangesNoBit) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.cubes[0].rotation = {{1, 2, 3}, 20};
  settings.simulation.integrator = Integrator::runge_kutta_4;
  const Model model = test::build(settings);
  auto whole = solver_for(model), split = solver_for(model);
  ASSERT_FALSE((*whole->advance(700)).divergence.has_value());
  ASSERT_FALSE((*split->advance(1)).divergence.has_value());
  ASSERT_FALSE((*split->advance(300)).divergence.has_value());
  auto resumed = solver_for(model, ForcePath::per_spring);
  ASSERT_TRUE(resumed->load(*split->state()).ok());
  ASSERT_FALSE((*resumed->advance(399)).divergence.has_value());
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
    const auto expected = reference->advance(100000)->divergence;
    ASSERT_TRUE(expected.has_value());
    for (const ForcePath path : {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring}) {
      auto solver = solver_for(model, path);
      const auto found = solver->advance(100000)->divergence;
      ASSERT_TRUE(found.has_value());
      EXPECT_EQ(found->step, expected->step);
      EXPECT_EQ(found->particle, expected->particle);
      EXPECT_EQ(found->finite, expected->finite);
      EXPECT_EQ(*solver->state(), *reference->state());
      EXPECT_EQ((*solver->advance(5)).divergence->step, expected->step);
      ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
      EXPECT_FALSE((*solver->advance(1)).divergence.has_value());
    }
  }
}

TEST_F(GpuSolverTest, ImplicitEulerStopsWhereTheReferenceStops) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.simulation.gravity = {0.0, 0.0, 1500.0};
  settings.terrain.clear();
  const Model model = test::build(settings);
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  const auto expected = reference->advance(1000)->divergence;
  ASSERT_TRUE(expected.has_value());
  auto solver = solver_for(model);
  const auto found = solver->advance(1000)->divergence;
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->step, expected->step);
  EXPECT_EQ(found->particle, expected->particle);
  EXPECT_EQ(*solver->state(), *reference->state());
  EXPECT_EQ((*solver->advance(5)).divergence->step, expected->step);
  ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
  EXPECT_FALSE((*solver->advance(1)).divergence.has_value());
}

TEST_F(GpuSolverTest, ImplicitEulerSplitChangesNoBitAndCountsTheSame) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 0.005;
  const Model model = test::build(settings);
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*reference->advance(50)).divergence.has_value());
  auto whole = solver_for(model), split = solver_for(model);
  ASSERT_FALSE((*whole->advance(50)).divergence.has_value());
  for (const std::uint64_t steps : {1u, 17u, 2u})
    ASSERT_FALSE((*split->advance(steps)).divergence.has_value());
  ASSERT_TRUE(split->load(*split->state()).ok());
  ASSERT_FALSE((*split->advance(30)).divergence.has_value());
  EXPECT_EQ(*split->state(), *whole->state());
  EXPECT_EQ(*whole->state(), *reference->state());
  const SolveStatistics counted = *whole->solve_statistics(), expected = *reference->solve_statistics();
  EXPECT_EQ(counted.steps, 50u);
  EXPECT_EQ(counted.converged, expected.converged);
  EXPECT_EQ(counted.newton_iterations, expected.newton_iterations);
  EXPECT_EQ(counted.cg_iterations, expected.cg_iterations);
  EXPECT_EQ(counted.worst_residual, expected.worst_residual);
  EXPECT_EQ(counted.last.residual, expected.last.residual);
  EXPECT_EQ(split->solve_statistics()->steps, 30u);
}

TEST_F(GpuSolverTest, NotANumberIsDivergenceAtTheLowestParticle) {
  const Model model = test::build(test::cube_on_plane(4));
  State state = initial_state(model, Precision::single);
  state.velocity[40].x = std::numeric_limits<float>::max();  // its springs' damping overflows
  auto solver = solver_for(model);
  ASSERT_TRUE(solver->load(state).ok());
  const auto found = solver->advance(1)->divergence;
  auto reference = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_TRUE(reference->load(state).ok());
  const auto expected = reference->advance(1)->divergence;
  ASSERT_TRUE(found && expected);
  EXPECT_EQ(found->particle, expected->particle);
  EXPECT_FALSE(found->finite);
  EXPECT_FALSE(expected->finite);
}

TEST_F(GpuSolverTest, HoldsAsManyBytesAsItSaid) {
  const Model model = test::build(test::cube_on_plane(6));
  for (const ForcePathRow& row : force_paths())
    EXPECT_EQ(solver_for(model, row.path)->bytes(), gpu_bytes(model, row.path)) << row.name;
  Model implicit = model;
  implicit.simulation.integrator = Integrator::implicit_euler;
  for (const ForcePath path : {ForcePath::lattice, ForcePath::gather})
    EXPECT_EQ(solver_for(implicit, path)->bytes(), gpu_bytes(implicit, path)) << name_of(path);
}

// As the window does it: each change of a constant is a new solver that shares the springs of the old one.
TEST_F(GpuSolverTest, SharesSpringsWithOneLikeIt) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.cubes[0].velocity = {1.0, -3.0, 0.5};
  const Model model = test::build(settings);
  settings.cubes[0].shear.stiffness = 900.0;
  settings.simulation.timestep = 0.0005;
  Model stiffer = test::build(settings);
  for (const ForcePath path : {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring}) {
    auto old = solver_for(model, path);
    const std::uint64_t held = context().bytes_held();
    GpuOptions options;
    options.force_path = path;
    options.share_springs_of = old.get();
    auto shared = test::value_of(make_gpu_solver(context(), stiffer, options));
    EXPECT_EQ(shared->spring_buffers(), old->spring_buffers());
    EXPECT_EQ(shared->bytes(), old->bytes());
    EXPECT_LT(context().bytes_held() - held, shared->bytes());
    old.reset();
    auto own = solver_for(stiffer, path);
    EXPECT_NE(shared->spring_buffers(), own->spring_buffers());
    ASSERT_FALSE((*shared->advance(300)).divergence.has_value());
    ASSERT_FALSE((*own->advance(300)).divergence.has_value());
    EXPECT_EQ(*shared->state(), *own->state());
  }

  // Another method may share them, another path or other springs may not.
  auto old = solver_for(model);
  GpuOptions options;
  options.force_path = ForcePath::gather;
  options.share_springs_of = old.get();
  Model implicit = model;
  implicit.simulation.integrator = Integrator::implicit_euler;
  auto solved = test::value_of(make_gpu_solver(context(), implicit, options));
  EXPECT_EQ(solved->spring_buffers(), old->spring_buffers());
  options.force_path = ForcePath::per_spring;
  auto other_path = test::value_of(make_gpu_solver(context(), model, options));
  EXPECT_NE(other_path->spring_buffers(), old->spring_buffers());
  options.force_path = ForcePath::gather;
  list_springs(stiffer);
  Spring& changed = stiffer.listed_springs[5];
  changed.spring_class = 1 - changed.spring_class;
  auto other_springs = test::value_of(make_gpu_solver(context(), stiffer, options));
  EXPECT_NE(other_springs->spring_buffers(), old->spring_buffers());
}

// Two solvers that share kernels, and with them the kernels' uniforms, step in turns.
TEST_F(GpuSolverTest, SharedKernelsKeepSolversApart) {
  ModelSettings settings = test::cube_on_plane(4, 1.2);
  settings.cubes[0].velocity = {1.0, -3.0, 0.5};
  settings.balls.push_back({0.5, 2.0, {0.2, 6.0, 0.1}, {0.0, -9.0, 0.0}, {}});
  for (const Integrator integrator :
       {Integrator::runge_kutta_4, Integrator::symplectic_euler, Integrator::implicit_euler}) {
    for (const ForcePath path : {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring}) {
      if (!works_with(path, integrator)) continue;  // refused by name
      settings.simulation.integrator = integrator;
      const Model model = test::build(settings);
      auto alone = solver_for(model, path);
      ASSERT_FALSE((*alone->advance(60)).divergence.has_value());
      const std::uint64_t compiled = context().programs().compiled();
      auto first = solver_for(model, path), second = solver_for(model, path);
      EXPECT_EQ(context().programs().compiled(), compiled);
      for (const std::uint64_t steps : {1u, 20u, 3u, 36u}) {
        ASSERT_FALSE((*first->advance(steps)).divergence.has_value());
        ASSERT_FALSE((*second->advance(steps == 36u ? 7u : 1u)).divergence.has_value());
      }
      EXPECT_EQ(*first->state(), *alone->state());
      ASSERT_FALSE((*second->advance(50)).divergence.has_value());
      EXPECT_EQ(*second->state(), *alone->state());
    }
  }
}

TEST_F(GpuSolverTest, RefusesWhatIsNotBuilt) {
  Model model = test::build(test::cube_on_plane(3));
  GpuOptions options;
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
