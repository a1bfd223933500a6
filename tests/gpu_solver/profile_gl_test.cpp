// Time by pass: which passes a step has, how often each is dispatched, and that looking changes no bit.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <string>

#include "gpu_solver/gpu_solver.h"
#include "model/integrator.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic {
namespace {

using Counts = std::map<std::string, double>;

class PassTimes : public aspic::testing::GlTest {
 protected:
  static std::unique_ptr<GpuSolver> solver_for(const Model& model, ForcePath path,
                                               BallSearch search = BallSearch::automatic) {
    GpuOptions options;
    options.force_path = path;
    options.ball_search = search;
    return test::value_of(make_gpu_solver(context(), model, options));
  }

  static Counts counts_of(const std::vector<gl::PassTime>& times) {
    Counts counts;
    for (const gl::PassTime& t : times) {
      EXPECT_TRUE(counts.emplace(t.name, t.dispatches).second) << t.name << " twice";
      EXPECT_GE(t.milliseconds, 0.0) << t.name;
      EXPECT_TRUE(std::isfinite(t.milliseconds)) << t.name;
    }
    return counts;
  }

  /// The times once they are there: the device gets to them without being waited for.
  static std::vector<gl::PassTime> times_of(GpuSolver& solver) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      if (auto times = solver.pass_times(); !times.empty()) return times;
    }
    ADD_FAILURE() << "no times after a minute";
    return {};
  }

  static double total(const std::vector<gl::PassTime>& times) {
    double sum = 0.0;
    for (const gl::PassTime& t : times) sum += t.milliseconds;
    return sum;
  }

  static ModelSettings low_cube(Integrator integrator, int n = 5) {
    ModelSettings settings = test::cube_on_plane(n, 1.9);
    settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
    settings.simulation.integrator = integrator;
    return settings;
  }
};

TEST_F(PassTimes, NameAndCountThePassesOfAnExplicitStep) {
  for (const Integrator integrator : all_integrators) {
    if (!row_of(integrator).staged()) continue;
    const Model model = test::build(low_cube(integrator));
    const double stages = force_evaluations_per_step(integrator);
    for (const ForcePath path : {ForcePath::lattice, ForcePath::gather, ForcePath::per_spring}) {
      auto solver = solver_for(model, path);
      solver->set_profiling(true);
      EXPECT_TRUE(solver->pass_times().empty());
      const std::uint64_t many = integrator == Integrator::explicit_euler ? 300 : 30;
      for (const std::uint64_t steps : {std::uint64_t{1}, std::uint64_t{10}, many})
        ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
      Counts expected = {{"springs, integration, contact", stages}};
      if (path == ForcePath::lattice) expected = {{"cubes: springs, integration, contact", stages}};
      if (path == ForcePath::per_spring)
        expected = {{"spring forces", stages}, {"sums, integration, contact", stages}};
      EXPECT_EQ(counts_of(times_of(*solver)), expected) << name_of(integrator);
    }
  }
}

// Blocks of one material and blocks of several are a dispatch each.
TEST_F(PassTimes, CountTheKindsOfBlocksOfCells) {
  ModelSettings settings = low_cube(Integrator::symplectic_euler);
  settings.cubes.clear();
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.position = {0.0, 9.0, 0.0};
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.layers = {{"1111112222"}};
  const Model model = test::build(settings);
  auto solver = solver_for(model, ForcePath::lattice);
  solver->set_profiling(true);
  ASSERT_FALSE((*solver->advance(10)).divergence.has_value());
  EXPECT_EQ(counts_of(times_of(*solver)), (Counts{{"cells: springs, integration, contact", 2.0}}));
}

TEST_F(PassTimes, NameAndCountThePassesOfAnImplicitStep) {
  ModelSettings settings = low_cube(Integrator::implicit_euler);
  settings.simulation.timestep = 0.01;
  const Model model = test::build(settings);
  auto solver = solver_for(model, ForcePath::gather);
  solver->set_profiling(true);
  for (const std::uint64_t steps : {1u, 20u, 3u})
    ASSERT_FALSE((*solver->advance(steps)).divergence.has_value());
  const Counts counts = counts_of(times_of(*solver));
  ASSERT_EQ(counts.size(), 6u);
  EXPECT_EQ(counts.at("start of the step"), 1.0);
  // A round is one of each; rounds are queued with some to spare, and a top-up ends in another end of the
  // step.
  EXPECT_GE(counts.at("residual"), 3.0);
  EXPECT_EQ(counts.at("Jacobian times direction"), counts.at("residual"));
  EXPECT_EQ(counts.at("solution update"), counts.at("residual"));
  EXPECT_EQ(counts.at("search direction"), counts.at("residual"));
  EXPECT_GE(counts.at("end of the step, contact"), 1.0);
}

TEST_F(PassTimes, NameAndCountTheBallsToo) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::implicit_euler}) {
    ModelSettings settings = low_cube(integrator);
    settings.balls.push_back({0.5, 2.0, {0.2, 6.0, 0.1}, {0.0, -9.0, 0.0}, {}});
    const Model model = test::build(settings);
    for (const BallSearch search : {BallSearch::all_pairs, BallSearch::grid}) {
      auto solver = solver_for(model, ForcePath::gather, search);
      solver->set_profiling(true);
      ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
      const Counts counts = counts_of(times_of(*solver));
      const bool solved = integrator == Integrator::implicit_euler, grid = search == BallSearch::grid;
      // The balls' part is queued after each end of the particles', of which a top-up adds one.
      const double ends = solved ? counts.at("end of the step, contact") : 1.0;
      EXPECT_EQ(counts.at("balls: flight and terrain"), ends);
      EXPECT_EQ(counts.at("balls: find contacts"), ends);
      EXPECT_EQ(counts.at("balls: find blocks of particles"), ends);
      EXPECT_EQ(counts.at("balls: search blocks"), ends);  // of particles: one ball makes no crowd
      EXPECT_EQ(counts.at("balls: count contacts"), ends);
      EXPECT_EQ(counts.at("balls: impulses on balls"), 3 * ends);
      EXPECT_EQ(counts.at("balls: impulses on particles"), 2 * ends);
      EXPECT_EQ(counts.at("balls: empty grid and marks"), ends);
      EXPECT_EQ(counts.at("balls: find faces"), ends);
      EXPECT_EQ(counts.at("balls: sum faces"), 2 * ends);
      EXPECT_EQ(counts.count("balls: fill the grid"), grid ? 1u : 0u);
      EXPECT_EQ(counts.count("balls: end of the step"), solved ? 1u : 0u);
    }
  }
}

// A step that is an advance() of its own is measured: its passes last no longer than the whole of it. They
// are what the host waits for, so that a wrong unit would show at the lower end.
TEST_F(PassTimes, AddUpToTheTimeOfTheRun) {
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::implicit_euler}) {
    const Model model = test::build(low_cube(integrator, 16));
    for (const ForcePath path : {ForcePath::gather, ForcePath::per_spring}) {
      if (integrator == Integrator::implicit_euler && path == ForcePath::per_spring) continue;  // refused
      auto solver = solver_for(model, path);
      ASSERT_FALSE(
          (*solver->advance(1)).divergence.has_value());  // drivers finish compiling at the first dispatch
      double measured = 0.0, passed = 0.0;
      for (int n = 0; n < 10; ++n) {
        solver->set_profiling(true);
        const auto start = std::chrono::steady_clock::now();
        ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
        const double step = total(times_of(*solver));
        const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - start;
        EXPECT_GT(step, 0.0);
        EXPECT_LE(step, whole.count()) << name_of(integrator) << ", " << name_of(path);
        measured += step;
        passed += whole.count();
        solver->set_profiling(false);
      }
      EXPECT_GT(measured, 0.05 * passed) << name_of(integrator) << ", " << name_of(path);
    }
  }
}

TEST_F(PassTimes, NeverAffectTheBits) {
  for (const Integrator integrator : {Integrator::runge_kutta_4, Integrator::implicit_euler}) {
    ModelSettings settings = low_cube(integrator);
    settings.balls.push_back({0.5, 2.0, {0.2, 6.0, 0.1}, {0.0, -9.0, 0.0}, {}});
    const Model model = test::build(settings);
    auto plain = solver_for(model, ForcePath::gather), watched = solver_for(model, ForcePath::gather);
    for (const std::uint64_t steps : {1u, 40u, 17u, 2u}) {
      watched->set_profiling(steps != 17u);
      ASSERT_FALSE((*plain->advance(steps)).divergence.has_value());
      ASSERT_FALSE((*watched->advance(steps)).divergence.has_value());
      EXPECT_EQ(*watched->state(), *plain->state());
      if (steps == 17u) {
        EXPECT_TRUE(watched->pass_times().empty());
      } else {
        EXPECT_FALSE(times_of(*watched).empty());
      }
    }
    EXPECT_TRUE(plain->pass_times().empty());
  }
}

}  // namespace
}  // namespace aspic
