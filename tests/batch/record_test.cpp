// The arrays of a recorded batch are the figures of each model's own run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <utility>

#include "aspic/analysis.h"
#include "aspic/batch.h"
#include "batch/instances.h"
#include "support/actuated.h"

namespace aspic {
namespace {

using test::take;
using ::testing::HasSubstr;

/// Cubes of 4³ of three time steps; the last one diverges.
std::vector<SharedModel> models_of(std::size_t count) {
  std::vector<SharedModel> models;
  for (std::size_t n = 0; n < count; ++n) {
    ModelSettings settings = test::low_cube(4, Integrator::symplectic_euler, ContactModel::coulomb);
    settings.simulation.timestep = n % 3 == 0 ? 1e-3 : n % 3 == 1 ? 5e-4 : 3e-4;
    settings.cubes[0].velocity.x = 0.1 * static_cast<double>(n);
    if (n + 1 == count) settings.cubes[0].structural.stiffness = 3e6;
    models.push_back(test::shared_model(settings));
  }
  return models;
}

TEST(BatchRecord, HasTheFiguresOfEachRunAlone) {
  const std::vector<SharedModel> models = models_of(34);
  Batch batch = take(Batch::create(models, {2}));
  const BatchRecord record =
      take(batch.run(0.1, 0.03, {.center_of_mass = true, .momentum = true, .energies = true, .body = 0}));
  ASSERT_EQ(record.instances, 34u);
  ASSERT_EQ(record.times, 5u);
  ASSERT_EQ(record.particles, 64u);
  const double times[] = {0.0, 0.03, 0.06, 0.09, 0.1};
  for (std::size_t i = 0; i < models.size(); ++i) {
    SCOPED_TRACE(i);
    const double h = models[i]->simulation.timestep;
    const auto solver = test::alone(models[i]);
    std::uint64_t step = 0;
    for (std::size_t n = 0; n < record.times; ++n) {
      const auto wanted = static_cast<std::uint64_t>(std::llround(times[n] / h));
      const auto divergence = take(solver->advance(wanted - step)).divergence;
      step = wanted;
      const State state = take(solver->state());
      const std::size_t at = i * record.times + n;
      EXPECT_EQ(record.time[at], static_cast<double>(state.step) * h);
      const Measures figures = measure(*models[i], state);
      EXPECT_EQ(record.energy[3 * at], figures.kinetic);
      EXPECT_EQ(record.energy[3 * at + 1], figures.elastic);
      EXPECT_EQ(record.energy[3 * at + 2], figures.gravitational);
      EXPECT_EQ(record.momentum[3 * at + 1], figures.momentum.y);
      for (std::size_t p = 0; p < 64; ++p)
        ASSERT_EQ(static_cast<double>(record.positions[3 * (at * 64 + p) + 2]), state.position[p].z);
      Vec3 center;
      for (const Vec3& x : state.position) center = center + 1.0 / 64 * x;
      EXPECT_NEAR(record.center_of_mass[3 * at], center.x, 1e-13);
      EXPECT_NEAR(record.center_of_mass[3 * at + 1], center.y, 1e-13);
      if (n + 1 < record.times) continue;
      EXPECT_EQ(record.diverged[i], divergence ? divergence->step : 0);
      EXPECT_EQ(divergence.has_value(), i == 33);
      EXPECT_EQ(record.hash[i], state_hash(state));
    }
  }
  // Rows after a divergence repeat the last good one.
  EXPECT_EQ(record.time[33 * 5 + 3], record.time[33 * 5 + 4]);
  EXPECT_EQ(record.energy[3 * (33 * 5 + 3)], record.energy[3 * (33 * 5 + 4)]);
}

TEST(BatchRecord, HasTheWorkOfActuators) {
  const std::vector<SharedModel> models = {
      test::shared_model(test::actuated(Integrator::symplectic_euler, ContactModel::coulomb)),
      test::shared_model(test::cube_on_plane(3))};
  Batch batch = take(Batch::create(models, {1}));
  Inputs inputs;
  inputs.channels = {0.6};
  ASSERT_TRUE(batch.set_inputs(0, inputs).ok());
  const BatchRecord record = take(batch.run(0.09, 0.03, {.center_of_mass = false, .actuator_work = true}));
  ASSERT_EQ(record.actuator_work.size(), 8u);
  const auto solver = test::alone(models[0]);
  ASSERT_TRUE(solver->set_inputs(inputs).ok());
  ActuatorWork work;
  for (std::size_t n = 0; n < 4; ++n) {
    const State state = take(solver->state());
    EXPECT_EQ(record.actuator_work[n], work.add(*models[0], state, solver->inputs()));
    EXPECT_EQ(record.actuator_work[4 + n], 0.0);
    ASSERT_TRUE(
        solver->advance(static_cast<std::uint64_t>(0.03 / models[0]->simulation.timestep + 0.5)).ok());
  }
  EXPECT_NE(record.actuator_work[3], 0.0);
}

TEST(BatchRecord, HasWhatIsAskedFor) {
  Batch batch = take(Batch::create(models_of(2), {1}));
  const BatchRecord record = take(batch.run(0.03, 0.01, {.center_of_mass = false, .momentum = true}));
  EXPECT_EQ(record.times, 4u);
  EXPECT_EQ(record.momentum.size(), 2u * 4 * 3);
  for (const auto* const other : {&record.center_of_mass, &record.energy, &record.actuator_work})
    EXPECT_TRUE(other->empty());
  EXPECT_TRUE(record.positions.empty());
  const BatchRecord again = take(batch.run(0.0, 1.0));  // from where it is
  EXPECT_EQ(again.times, 1u);
  EXPECT_EQ(again.time[0], 0.03);
  EXPECT_EQ(again.hash, record.hash);
}

TEST(BatchRecord, RefusesWhatItCannotRecord) {
  std::vector<SharedModel> models = models_of(2);
  models.push_back(test::shared_model(test::cube_on_plane(3)));
  Batch batch = take(Batch::create(models, {1}));
  const auto refusal = [&](double duration, double interval, const BatchQuantities& quantities = {}) {
    const auto record = batch.run(duration, interval, quantities);
    EXPECT_FALSE(record.ok());
    return record.ok() ? "" : record.error().message();
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(-1.0, 0.1), HasSubstr("not for -1 s"));
  EXPECT_THAT(refusal(nan, 0.1), HasSubstr("not for nan s"));
  EXPECT_THAT(refusal(1.0, 0.0), HasSubstr("more than 0 s, not 0 s"));
  EXPECT_THAT(refusal(1e300, 1e299), HasSubstr("2^53 steps"));
  EXPECT_THAT(refusal(1.0, 0.1, {.body = 1}), HasSubstr("instance 0 has no body 1"));
  EXPECT_THAT(refusal(1.0, 0.1, {.body = 0}), HasSubstr("64 particles in instance 0 and 27 in instance 2"));
  EXPECT_THAT(refusal(1.0, 1e-300), HasSubstr("record less often"));
  std::atomic<bool> stop = true;
  batch.set_stop_flag(&stop);
  EXPECT_EQ(batch.run(1.0, 0.1).error().code, ErrorCode::interrupted);
  EXPECT_EQ(take(batch.state(0)).step, 0u);
}

}  // namespace
}  // namespace aspic
