// The cpu backend ends with the same bits as the reference in single precision: any scene, integrator and
// contact model, any number of threads, any instruction set.
#include "cpu_parallel/cpu_solver.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "cpu_reference/reference_solver.h"
#include "support/contact_rules.h"
#include "support/equality_cases.h"
#include "support/golden_runs.h"
#include "support/integrator_names.h"
#include "support/lattice_bodies.h"
#include "support/model_building.h"
#include "support/random_state.h"
#include "support/reference_runs.h"

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
  const auto bad = expected->advance(steps)->divergence, also_bad = solver->advance(steps)->divergence;
  ASSERT_EQ(bad.has_value(), also_bad.has_value());
  if (bad) {
    EXPECT_EQ(bad->step, also_bad->step);
    EXPECT_EQ(bad->particle, also_bad->particle);
    EXPECT_EQ(bad->finite, also_bad->finite);
    EXPECT_EQ(bad->ball, also_bad->ball);
    EXPECT_EQ(bad->residual, also_bad->residual);
  }
  EXPECT_EQ(*expected->state(), *solver->state());
  EXPECT_EQ(state_hash_text(*expected->state()), state_hash_text(*solver->state()));
}

/// Calls `test` with every instruction set of the machine.
template <class Test>
void with_every_instruction_set(const Test& test) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    test();
  }
  hwy::SetSupportedTargetsForTest(0);
}

class EveryMethodOnTheCpu : public testing::TestWithParam<Integrator> {
 protected:
  static std::uint64_t steps(std::uint64_t long_ones, std::uint64_t others) {
    return row_of(GetParam()).traits.long_steps ? long_ones : others;
  }
};
INSTANTIATE_TEST_SUITE_P(CpuSolver, EveryMethodOnTheCpu, testing::ValuesIn(all_integrators),
                         test::by_integrator);

/// The solver ends the run with the state that the reference is known to end it with.
void expect_golden(const test::GoldenRun& run) {
  const Model model = run.model();
  const auto solver = cpu(model);
  ASSERT_TRUE(solver->advance(run.steps).ok());
  test::expect_golden(run, *solver->state());
}

TEST(CpuSolver, HasTheReferencesBitsInEveryBuiltInScene) {
  for (const test::GoldenRun& run : test::core_scene_runs()) expect_golden(run);
}

constexpr std::uint64_t long_run = 2000;  // steps

void expect_hardware_states(bool long_ones) {
  int count = 0;
  for (const test::HardwareRun& run : test::hardware_runs()) {
    if ((run.steps > long_run) != long_ones) continue;
    ++count;
    const auto solver = cpu(run.model());
    ASSERT_TRUE(solver->advance(run.steps).ok());
    EXPECT_EQ(state_hash_text(*solver->state()), run.hash) << run.text();
  }
  EXPECT_EQ(count, long_ones ? 1 : 102);
}

// An NVIDIA H200 ended these runs with the same states; it flushes denormal numbers.
TEST(CpuSolver, EndsRunsWithTheStatesOfAnH200) {
  expect_hardware_states(false);
}
TEST(CpuSolver, EndsLongRunsWithTheStatesOfAnH200) {
  expect_hardware_states(true);
}

TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsInEveryBuiltInScene) {
  for (const test::GoldenRun& run : test::scene_runs()) {
    if (run.method == GetParam()) expect_golden(run);
  }
}

TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsInTheCoveringSet) {
  for (const test::EqualityCase& row : test::covering_cases()) {
    if (row.integrator == GetParam()) expect_golden(test::golden_run(row));
  }
}

// Planes and rows shorter and longer than a vector, of two particles too.
TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsInBoxesOfAnyEdges) {
  ModelSettings settings = test::with_odd_boxes(test::low_cube(2, GetParam(), ContactModel::coulomb));
  test::set_down(settings, 0.01);
  for (const unsigned threads : {1u, 3u}) expect_equal(test::build(settings), steps(12, 60), threads);
}

TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsInABodyWithEmptyCells) {
  const ModelSettings settings = test::low_cube(2, GetParam(), ContactModel::coulomb);
  expect_equal(test::with_cells(settings, test::lattice_of("xxx,x.x,xxx;xxx,...,x..")), steps(12, 120), 2);
}

// Slices of a row each, of several rows, and of parts of rows; materials that change within a slice; threads
// whose parts begin anywhere. 40 cells a row are more than two slices.
TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsInBodiesOfCells) {
  ModelSettings settings = test::low_cube(2, GetParam(), ContactModel::coulomb);
  settings.cubes.clear();
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  CellLayers layers(7, std::vector<std::string>(40, std::string(9, '1')));
  for (std::size_t y = 0; y < layers.size(); ++y) {
    for (std::size_t z = 0; z < layers[y].size(); ++z) {
      for (std::size_t x = 0; x < layers[y][z].size(); ++x) {
        char& cell = layers[y][z][x];
        if (x + z > y + 35 || (x * x + y * y + z) % 11 == 0) cell = '.';
        if (cell != '.' && (x * y + z) % 5 == 0) cell = '2';
      }
    }
  }
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.2;
  voxels.position = {0.0, 0.8, 0.0};
  voxels.velocity = {0.5, -1.0, 0.2};
  voxels.layers = layers;
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.pieces = Pieces::all;
  settings.simulation.timestep = row_of(GetParam()).traits.long_steps ? 0.01 : 0.0005;
  const Model model = test::build(settings);
  ASSERT_GT(model.particle_count(), 2500u);
  for (const unsigned threads : {1u, 4u}) expect_equal(model, steps(3, 60), threads);
}

TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsOnTerrainThatMovesSideways) {
  for (const ContactModel contact : both_models) {
    SCOPED_TRACE(name_of(contact));
    ModelSettings settings = test::low_cube(5, GetParam(), contact);
    settings.terrain[0].motion = TerrainMotion{{1.0, 0.0, 0.4}, 0.3, 1.1, 0.2};
    test::set_down(settings, 0.01);
    expect_equal(test::build(settings), steps(25, 160), 2);
    settings.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
    expect_equal(test::build(settings), steps(25, 160), 2);
  }
}

// A cube in the air and a wall whose place at rest is 18 m away: it meets the cube after about 40 steps.
TEST_P(EveryMethodOnTheCpu, SeesTerrainThatComesFromFar) {
  for (const ContactModel contact : both_models) {
    SCOPED_TRACE(name_of(contact));
    ModelSettings settings = test::low_cube(5, GetParam(), contact);
    settings.cubes[0].position.y = 50.0;
    settings.cubes[0].velocity.x = -1.0;
    settings.terrain.push_back(
        {.geometry = {{"point", Vec3{-20.6, 0.0, 0.0}}, {"normal", Vec3{1.0, 0.0, 0.0}}}});
    const Model still = test::build(settings);
    settings.terrain[1].motion = TerrainMotion{{1.0, 0.0, 0.0}, 18.0, 0.1, 0.23};
    const Model model = test::build(settings);
    expect_equal(model, 120, 2);
    const auto without = reference(still), with = reference(model);
    ASSERT_FALSE((*without->advance(120)).divergence.has_value());
    ASSERT_FALSE((*with->advance(120)).divergence.has_value());
    EXPECT_FALSE(*without->state() == *with->state()) << "the wall does not reach the cube";
  }
}

TEST_P(EveryMethodOnTheCpu, HasTheReferencesBitsWithAnyNumberOfThreads) {
  for (const ContactModel contact : both_models) {
    ModelSettings settings = test::low_cube(9, GetParam(), contact);
    test::set_down(settings, 0.01);
    const Model model = test::build(settings);
    for (const unsigned threads : {1u, 2u, 5u}) {
      SCOPED_TRACE(fmt::format("{}, {} threads", name_of(contact), threads));
      expect_equal(model, steps(10, 60), threads);
    }
  }
}

/// A cube and a goal net of cords, several bodies with lists and lattices.
ModelSettings cube_and_cords(Integrator integrator, ContactModel contact) {
  ModelSettings settings = test::low_cube(7, integrator, contact);
  settings.goal_nets.emplace_back();
  settings.goal_nets[0].cord = true;
  settings.goal_nets[0].shear.stiffness = settings.goal_nets[0].bending.stiffness = 300.0;
  settings.contact.bodies = false;  // they lie in each other
  test::set_down(settings, 0.01);
  return settings;
}

TEST(CpuSolver, HasTheReferencesBitsWithEveryInstructionSet) {
  with_every_instruction_set([] {
    expect_equal(test::build(cube_and_cords(Integrator::runge_kutta_4, ContactModel::coulomb)), 60, 2);
    for (const ContactModel contact : both_models)
      expect_equal(test::build(cube_and_cords(Integrator::implicit_euler, contact)), 10, 2);
  });
}

TEST(CpuSolver, HasTheReferencesBitsForEverySizeOfCube) {
  for (const int n : {2, 3, 4, 5, 6, 8, 16, 17, 33}) {
    SCOPED_TRACE(n);
    expect_equal(test::build(test::low_cube(n, Integrator::symplectic_euler, ContactModel::coulomb)), 30);
    // The Jacobians of 33 per edge are not kept.
    expect_equal(test::build(test::low_cube(n, Integrator::implicit_euler, ContactModel::coulomb)),
                 n < 16 ? 8 : 2);
  }
}

// Nothing of a solve is hidden: the same iterations, ends and residuals; stagnated where the springs are too
// stiff for the tolerance, not converged where iterations run out.
TEST(CpuSolver, SolvesAsTheReferenceDoes) {
  std::array<std::uint64_t, 3> ends{};
  for (const auto& [stiffness, iterations] : {std::pair(2000.0, 20), {2e5, 20}, {2000.0, 1}}) {
    ModelSettings settings = cube_and_cords(Integrator::implicit_euler, ContactModel::coulomb);
    settings.simulation.timestep = 1.0 / 60;
    settings.simulation.implicit.newton_iterations = iterations;
    for (auto* const family : {&settings.cubes[0].structural, &settings.cubes[0].shear})
      family->stiffness = stiffness;
    const Model model = test::build(settings);
    const auto expected = reference(model), solver = cpu(model, 2);
    ASSERT_TRUE(expected->advance(40).ok());
    ASSERT_TRUE(solver->advance(40).ok());
    const SolveStatistics wanted = *expected->solve_statistics(), got = *solver->solve_statistics();
    EXPECT_EQ(got.steps, 40u);
    EXPECT_EQ(got.converged, wanted.converged);
    EXPECT_EQ(got.stagnated, wanted.stagnated);
    EXPECT_EQ(got.not_converged, wanted.not_converged);
    EXPECT_EQ(got.newton_iterations, wanted.newton_iterations);
    EXPECT_EQ(got.cg_iterations, wanted.cg_iterations);
    EXPECT_EQ(got.worst_residual, wanted.worst_residual);
    EXPECT_EQ(got.last.residual, wanted.last.residual);
    ends[0] += got.converged, ends[1] += got.stagnated, ends[2] += got.not_converged;
  }
  for (const std::uint64_t count : ends) EXPECT_GT(count, 0u) << "every end should occur";
}

TEST(CpuSolver, GivesSpringsWithoutLengthNoForce) {
  // All particles in one place: every spring has length 0 until gravity and the pinned ones part them.
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes[0].pinned.names = {"left-top-front"};
  Model model = test::build(settings);
  model.initial_position = std::vector<Vec3>(model.particle_count(), {0.0, 2.0, 0.0});
  expect_equal(model, 50, 2);
  model.simulation.integrator = Integrator::implicit_euler;
  expect_equal(model, 50, 2);
}

TEST(CpuSolver, PullsAsTheReferenceDoes) {
  for (const auto& [integrator, contact] : {std::pair(Integrator::midpoint, ContactModel::course),
                                            {Integrator::implicit_euler, ContactModel::course},
                                            {Integrator::implicit_euler, ContactModel::coulomb}}) {
    SCOPED_TRACE(fmt::format("{}, {}", name_of(integrator), name_of(contact)));
    const Model model = test::build(test::low_cube(6, integrator, contact));
    const auto expected = reference(model), solver = cpu(model, 2);
    for (const std::uint32_t particle : {0u, 215u, 100u}) {
      const Pull pull = {particle, {0.3, 4.0, 0.1}, 800.0, 20.0};
      for (Solver* const each : {expected.get(), solver.get()}) {
        ASSERT_TRUE(each->set_inputs(inputs_of(pull)).ok());
        ASSERT_TRUE(each->advance(60).ok());
      }
      EXPECT_EQ(*expected->state(), *solver->state());
    }
    EXPECT_FALSE(solver->set_inputs({{Pull{216, {}, 1.0, 1.0}}}).ok());
  }
}

TEST(CpuSolver, PullsBallsAsTheReferenceDoes) {
  for (const Integrator integrator : all_integrators) {
    SCOPED_TRACE(name_of(integrator));
    ModelSettings settings = test::low_cube(6, integrator, ContactModel::coulomb);
    settings.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
    const Model model = test::build(settings);
    const auto expected = reference(model), solver = cpu(model, 2), untouched = reference(model);
    for (Solver* const each : {expected.get(), solver.get()}) {
      ASSERT_TRUE(each->set_inputs({{Pull{0, {0.3, 4.0, 0.1}, 300.0, 20.0, true}}}).ok());
      ASSERT_TRUE(each->advance(200).ok());
    }
    EXPECT_EQ(*expected->state(), *solver->state());
    ASSERT_TRUE(untouched->advance(200).ok());
    EXPECT_GT(length(expected->state()->ball_position[0] - untouched->state()->ball_position[0]), 0.1);
  }
}

TEST(CpuSolver, NamesTheSameDivergence) {
  ModelSettings settings = test::low_cube(6, Integrator::explicit_euler, ContactModel::coulomb);
  settings.simulation.timestep = 0.02;
  const Model model = test::build(settings);
  const auto solver = cpu(model, 2);
  const auto divergence = solver->advance(5000)->divergence;
  ASSERT_TRUE(divergence.has_value());
  expect_equal(model, 5000, 2);
  // The last good step stays, and the same divergence is reported until a state is loaded.
  EXPECT_EQ((*solver->state()).step + 1, divergence->step);
  EXPECT_EQ((*solver->advance(1)).divergence->step, divergence->step);
  ASSERT_TRUE(solver->load(initial_state(model, Precision::single)).ok());
  EXPECT_FALSE((*solver->advance(1)).divergence.has_value());
}

TEST(CpuSolver, NamesTheSameDivergenceOfASolve) {
  ModelSettings settings = test::low_cube(4, Integrator::implicit_euler, ContactModel::coulomb);
  settings.cubes[0].velocity.x = 2000.0;
  expect_equal(test::build(settings), 3, 2);
  // Rounding alone makes forces that no acceleration in single precision can hold.
  settings.cubes[0].velocity.x = 0.0;
  settings.terrain.clear();
  settings.cubes[0].particle_mass = 1.9e-38;
  settings.cubes[0].structural.stiffness = 1e12;
  const Model model = test::build(settings);
  const auto solver = cpu(model, 2);
  const auto divergence = solver->advance(3)->divergence;
  ASSERT_TRUE(divergence.has_value());
  EXPECT_TRUE(divergence->residual);
  EXPECT_EQ(solver->solve_statistics()->steps, 0u);
  expect_equal(model, 3, 2);
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

/// The particles of a state as numbers of type T, the first of vector i at i·stride, component c at
/// c·component.
template <class T>
void expect_read(Solver& solver, const State& state, std::size_t stride, std::size_t component) {
  const std::size_t count = state.position.size(), size = (count - 1) * stride + 2 * component + 1;
  std::vector<T> x(size + 2, T(-1)), v = x;
  const auto vectors = [&](std::vector<T>& to) {
    return Strided<T>{to.data() + 1, count, static_cast<std::ptrdiff_t>(stride),
                      static_cast<std::ptrdiff_t>(component)};
  };
  StateView view;
  view[field_number("position")] = vectors(x);
  view[field_number("velocity")] = vectors(v);
  ASSERT_TRUE(solver.read_into(view).ok());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = 1 + i * stride + static_cast<std::size_t>(c) * component;
      wrong += x[at] != static_cast<T>(state.position[i][c]) || v[at] != static_cast<T>(state.velocity[i][c]);
    }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(x.front(), T(-1)) << "the places around stay as they were";
  EXPECT_EQ(x.back(), T(-1));
}

// More particles than one piece of work has, and a number that no register's lanes divide.
TEST(CpuSolver, AllThreadsReadAndWriteAState) {
  const Model model = test::build(test::cube_on_plane(27));
  const std::size_t count = model.particle_count();
  const State state = test::random_bits_state(count, Precision::single, 3, 0);
  with_every_instruction_set([&] {
    for (const unsigned threads : {1u, 3u}) {
      const auto solver = cpu(model, threads);
      ASSERT_TRUE(solver->load(state).ok());
      EXPECT_EQ(*solver->state(), state);
      expect_read<float>(*solver, state, 3, 1);
      expect_read<float>(*solver, state, 5, 1);
      expect_read<float>(*solver, state, 1, count);
      expect_read<double>(*solver, state, 3, 1);
    }
  });
}

TEST(CpuSolver, FollowsTheRulesThatKeepRoundingFromDecidingAboutContact) {
  const auto make = [](const Model& model) { return cpu(model); };
  test::expect_landing_to_rest(make);
  test::expect_more_friction_to_hold(make);
  expect_equal(test::cube_on_slope(std::array{0.1, 0.0, 0.5, 0.2}), 60);
  ModelSettings settings = test::low_cube(4, Integrator::explicit_euler, ContactModel::coulomb);
  settings.contact.restitution = 0.0;
  expect_equal(test::build(settings), 400);
}

TEST(CpuSolver, FollowsEachThresholdOfContact) {
  for (const ContactModel contact : both_models) {
    std::set<std::uint64_t> ends;
    for (const Model& model : test::landings(contact)) {
      expect_equal(model, 200);
      ends.insert(state_hash(test::after(model, 200, Precision::single)));
    }
    EXPECT_EQ(ends.size(), 3u) << name_of(contact);
  }
}

}  // namespace
}  // namespace aspic
