// Every instance of a batch ends with the bits of a solver that has its model alone, whatever the others are
// and however many threads compute.
#include "aspic/batch.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <utility>

#include "batch/instances.h"
#include "support/busy_inputs.h"

namespace aspic {
namespace {

using test::alone;
using test::take;
using ::testing::HasSubstr;

Batch batch_of(const std::vector<SharedModel>& models, unsigned threads) {
  return take(Batch::create(models, {threads}));
}

void expect_equal(const Batch& batch, std::size_t instance, Solver& solver) {
  SCOPED_TRACE(fmt::format("instance {}", instance));
  const State got = take(batch.state(instance)), wanted = take(solver.state());
  EXPECT_EQ(got, wanted);
  EXPECT_EQ(state_hash(got), state_hash(wanted));
}

void expect_equal(const std::optional<Divergence>& got, const std::optional<Divergence>& wanted) {
  ASSERT_EQ(got.has_value(), wanted.has_value());
  if (!got) return;
  EXPECT_EQ(got->step, wanted->step);
  EXPECT_EQ(got->particle, wanted->particle);
  EXPECT_EQ(got->finite, wanted->finite);
  EXPECT_EQ(got->ball, wanted->ball);
  EXPECT_EQ(got->residual, wanted->residual);
}

/// Cubes of one topology that differ in all else, about to touch the ground.
std::vector<SharedModel> cubes(int edge, std::size_t count, Integrator integrator, bool moving = false) {
  std::vector<SharedModel> models;
  for (std::size_t n = 0; n < count; ++n) {
    ModelSettings settings = test::low_cube(edge, integrator, ContactModel::coulomb);
    const auto differs = static_cast<double>(n);
    settings.cubes[0].position.x = 0.3 * differs;
    settings.cubes[0].velocity.z = 0.1 * differs;
    settings.cubes[0].structural.stiffness *= 1.0 + 0.05 * differs;
    settings.cubes[0].particle_mass *= 1.0 + 0.1 * differs;
    settings.simulation.gravity.y = -9.8 + 0.4 * differs;
    settings.terrain[0].friction = 0.1 * static_cast<double>(n % 5);
    if (moving) settings.terrain[0].motion = TerrainMotion{{1.0, 0.5, 0.4}, 0.2, 1.0 + 0.1 * differs, 0.2};
    models.push_back(test::shared_model(settings));
  }
  return models;
}

/// Whatever a scene may have, small and large.
std::vector<SharedModel> mixture() {
  std::vector<SharedModel> models = cubes(5, 12, Integrator::symplectic_euler);
  const auto add = [&](const std::vector<SharedModel>& more) {
    models.insert(models.end(), more.begin(), more.end());
  };
  add(cubes(4, 10, Integrator::midpoint, true));
  add(cubes(3, 2, Integrator::explicit_euler));
  add(cubes(4, 1, Integrator::implicit_euler));
  add(cubes(18, 1, Integrator::symplectic_euler));
  ModelSettings cloth;
  cloth.cloths.emplace_back();
  cloth.cloths[0].particles = {9, 12};
  cloth.terrain.emplace_back();
  add({test::shared_model(cloth)});
  ModelSettings balls = test::low_cube(4, Integrator::runge_kutta_4, ContactModel::course);
  balls.balls.push_back({0.3, 2.0, {3.0, 0.4, 0.2}, {-1.0, -2.0, 0.5}, {3.0, 1.0, -2.0}});
  balls.launchers.emplace_back();
  add({test::shared_model(balls)});
  models.push_back(models[3]);  // the same object again
  return models;
}

TEST(Batch, EveryInstanceHasTheBitsOfItsModelAlone) {
  const std::vector<SharedModel> models = mixture();
  constexpr std::uint64_t steps = 60;
  std::vector<std::unique_ptr<Solver>> solvers;
  for (const SharedModel& model : models) {
    solvers.push_back(alone(model));
    ASSERT_FALSE(take(solvers.back()->advance(steps)).divergence.has_value());
  }
  for (const unsigned threads : {1u, 2u, 5u}) {
    SCOPED_TRACE(fmt::format("{} threads", threads));
    Batch batch = batch_of(models, threads);
    ASSERT_EQ(batch.size(), models.size());
    EXPECT_EQ(take(batch.advance(steps / 3)), 0u);
    EXPECT_EQ(take(batch.advance(steps - steps / 3)), 0u);
    for (std::size_t i = 0; i < models.size(); ++i) expect_equal(batch, i, *solvers[i]);
  }
}

TEST(Batch, ADivergedInstanceStopsAlone) {
  std::vector<SharedModel> models = cubes(4, 14, Integrator::symplectic_euler);
  ModelSettings stiff = test::low_cube(4, Integrator::symplectic_euler, ContactModel::coulomb);
  stiff.cubes[0].structural.stiffness = 1e7;
  models[5] = test::shared_model(stiff);
  stiff.cubes[0].pinned.names = {"top"};
  stiff.cubes[0].structural.stiffness = 1e6;
  models.push_back(test::shared_model(stiff));  // another topology: alone
  for (const unsigned threads : {1u, 2u}) {
    SCOPED_TRACE(fmt::format("{} threads", threads));
    Batch batch = batch_of(models, threads);
    EXPECT_EQ(take(batch.advance(200)), 2u);
    EXPECT_EQ(take(batch.advance(50)), 2u);
    for (std::size_t i = 0; i < models.size(); ++i) {
      const auto solver = alone(models[i]);
      const auto divergence = take(solver->advance(250)).divergence;
      EXPECT_EQ(divergence.has_value(), i == 5 || i == 14);
      expect_equal(take(batch.divergence(i)), divergence);
      expect_equal(batch, i, *solver);
    }
    EXPECT_EQ(take(batch.state(5)).step + 1, take(batch.divergence(5))->step);
  }
}

TEST(Batch, ResetsThoseOfAMaskAndKeepsTheirInputs) {
  std::vector<SharedModel> models = cubes(4, 12, Integrator::symplectic_euler, true);
  ModelSettings stiff = test::low_cube(4, Integrator::symplectic_euler, ContactModel::coulomb);
  stiff.cubes[0].structural.stiffness = 1e7;
  stiff.terrain[0].motion = TerrainMotion{{1.0, 0.5, 0.4}, 0.2, 1.0, 0.2};
  models[5] = test::shared_model(stiff);
  Batch batch = batch_of(models, 2);
  const Inputs hand = inputs_of(Pull{3, {0.3, 4.0, 0.1}, 300.0, 20.0});
  ASSERT_TRUE(batch.set_inputs(2, hand).ok());
  ASSERT_EQ(take(batch.advance(150)), 1u);
  std::vector<std::uint8_t> mask(12, 0);
  mask[2] = mask[5] = mask[11] = 1;
  ASSERT_TRUE(batch.reset(mask).ok());
  EXPECT_FALSE(take(batch.divergence(5)).has_value());
  EXPECT_EQ(take(batch.state(5)), initial_state(*models[5], Precision::single));
  EXPECT_EQ(take(batch.advance(20)), 1u) << "it diverges again";
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto solver = alone(models[i]);
    ASSERT_TRUE(solver->set_inputs(i == 2 ? hand : Inputs{}).ok());
    ASSERT_TRUE(solver->advance(mask[i] != 0 ? 20 : 170).ok());
    expect_equal(batch, i, *solver);
  }
  ASSERT_TRUE(batch.reset().ok());
  for (std::size_t i = 0; i < models.size(); ++i)
    EXPECT_EQ(take(batch.state(i)), initial_state(*models[i], Precision::single));
  mask.pop_back();
  EXPECT_THAT(batch.reset(mask).error().message(), HasSubstr("the mask has 11 numbers"));
}

TEST(Batch, EachHasItsOwnInputsAndConstants) {
  ModelSettings settings = test::low_cube(4, Integrator::velocity_verlet, ContactModel::coulomb);
  settings.cubes[0].pinned.names = {"left-top-front"};
  const SharedModel model = test::shared_model(settings);
  const auto changed = [&](double gravity, double stiffness, double timestep) {
    ModelSettings other = settings;
    other.simulation.gravity.y = gravity;
    other.cubes[0].structural.stiffness = stiffness;
    other.simulation.timestep = timestep;
    return test::shared_model(other);
  };
  const double h = settings.simulation.timestep;
  const std::vector<SharedModel> constants = {changed(-1.6, 1500.0, h), changed(-9.8, 1e7, h),
                                              changed(-3.7, 900.0, h / 2), changed(-24.8, 1200.0, h)};
  Batch batch = batch_of(std::vector<SharedModel>(13, model), 2);
  std::vector<std::unique_ptr<Solver>> solvers;
  for (std::size_t i = 0; i < batch.size(); ++i) solvers.push_back(alone(model));
  const InputLog log = test::busy_inputs(*model, 20);
  for (std::size_t period = 0; period < 6; ++period) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Inputs& inputs = log.at((period + i) % 5 * 20);
      ASSERT_TRUE(batch.set_inputs(i, inputs).ok());
      ASSERT_TRUE(solvers[i]->set_inputs(inputs).ok());
      if ((period + i) % 3 != 0) continue;
      // One of them diverges, and comes back with the next; one leaves the others for its time step.
      const SharedModel& next = constants[(period / 3 + i) % constants.size()];
      ASSERT_TRUE(batch.set_constants(i, next).ok());
      ASSERT_TRUE(solvers[i]->set_constants(next).ok());
      EXPECT_EQ(take(batch.model(i)), next);
    }
    std::size_t diverged = 0;
    for (const auto& solver : solvers) diverged += take(solver->advance(20)).divergence.has_value() ? 1 : 0;
    EXPECT_EQ(take(batch.advance(20)), diverged);
    EXPECT_TRUE(diverged > 0 || period == 0);
    for (std::size_t i = 0; i < batch.size(); ++i) expect_equal(batch, i, *solvers[i]);
  }
  EXPECT_EQ(batch.set_inputs(4, {{Pull{64, {}, 1.0, 1.0}}}).error().code, ErrorCode::usage);
  EXPECT_THAT(batch.set_constants(4, cubes(5, 1, Integrator::midpoint)[0]).error().message(),
              HasSubstr("the bodies of the two models differ"));
}

TEST(Batch, LoadsAndReadsStates) {
  const std::vector<SharedModel> models = cubes(4, 12, Integrator::runge_kutta_4, true);
  const auto solver = alone(models[7]);
  ASSERT_TRUE(solver->advance(77).ok());
  const State state = take(solver->state());
  Batch batch = batch_of(models, 1);
  ASSERT_TRUE(batch.load(7, state).ok());
  EXPECT_EQ(take(batch.advance(40)), 0u);
  ASSERT_TRUE(solver->advance(40).ok());
  expect_equal(batch, 7, *solver);
  std::vector<float> places(3 * 64);
  StateView view;
  view[field_number("position")] = Strided<float>{places.data(), 64};
  EXPECT_EQ(take(batch.read_into(7, view)), 117u);
  EXPECT_EQ(static_cast<double>(places[4]), take(solver->state()).position[1].y);
  ASSERT_TRUE(batch.load(8, view_of(state), 5).ok());
  EXPECT_EQ(take(batch.state(8)).step, 5u);

  view[field_number("position")] = Strided<float>{places.data(), 63};
  EXPECT_EQ(batch.read_into(7, view).error().code, ErrorCode::usage);
  EXPECT_EQ(batch.load(7, State{}).error().code, ErrorCode::usage);
  State broken = state;
  broken.velocity[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(batch.load(7, broken).error().message(), HasSubstr("the velocity of particle 3"));
  EXPECT_EQ(batch.load(7, ConstStateView{}, 0).error().code, ErrorCode::usage);
  EXPECT_THAT(batch.state(12).error().message(), HasSubstr("the batch has 12, numbered from 0"));
}

TEST(Batch, StopsEachAtTheEndOfAStep) {
  const std::vector<SharedModel> models = mixture();
  for (const unsigned threads : {2u, 5u}) {
    Batch batch = batch_of(models, threads);
    std::atomic<bool> stop = false;
    batch.set_stop_flag(&stop);
    std::thread clock([&stop] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      stop = true;
    });
    EXPECT_EQ(take(batch.advance(100'000'000)), 0u);
    clock.join();
    for (const std::size_t i : {0u, 12u, 23u, 26u, 27u}) {
      const auto solver = alone(models[i]);
      ASSERT_TRUE(solver->advance(take(batch.state(i)).step).ok());
      expect_equal(batch, i, *solver);
    }
    stop = false;
    EXPECT_EQ(take(batch.advance(1)), 0u);
  }
}

TEST(Batch, SharesWhatModelsHaveInCommon) {
  const SharedModel model = cubes(6, 1, Integrator::symplectic_euler)[0];
  const Batch batch = batch_of(std::vector<SharedModel>(100, model), 2);
  EXPECT_LT(batch.bytes(), 100 * alone(model)->bytes() * 3 / 4);
  EXPECT_THAT(batch.description(), HasSubstr("100 instances, 100 of them in 7 stacks, cpu, 2 threads"));
}

TEST(Batch, RefusesWhatItCannotCompute) {
  EXPECT_THAT(Batch::create({}).error().message(), HasSubstr("at least one model"));
  EXPECT_THAT(Batch::create({cubes(3, 1, Integrator::midpoint)[0], nullptr}).error().message(),
              HasSubstr("instance 1 is null"));
  EXPECT_THAT(Batch::create(cubes(3, 1, Integrator::midpoint), {1025}).error().message(), HasSubstr("1024"));
  setenv("ASPIC_THREADS", "many", 1);
  EXPECT_EQ(Batch::create(cubes(3, 1, Integrator::midpoint)).error().code, ErrorCode::usage);
  unsetenv("ASPIC_THREADS");
}

}  // namespace
}  // namespace aspic
