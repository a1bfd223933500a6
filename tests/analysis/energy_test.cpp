#include <gtest/gtest.h>

#include "aspic/analysis.h"
#include "model/model.h"

namespace aspic {
namespace {

/// Two particles and one spring, all figures small integers so that every sum is exact.
Model pair(bool cord) {
  Model model;
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.mass = {2.0, 4.0};
  model.inverse_mass = {0.5, 0.25};
  model.spring_classes = {{SpringType::structural, 8.0, 1.0, 2.0, cord}};
  model.listed_springs = {{0, 1, 0}};
  return model;
}

State state_at(double distance) {
  State state;
  state.position = {{0.0, 3.0, 0.0}, {distance, 1.0 + 2.0, 0.0}};
  state.velocity = {{1.0, 2.0, 2.0}, {0.0, -1.0, 0.0}};
  return state;
}

TEST(Energy, SumsOfAPairByHand) {
  const Measures m = measure(pair(false), state_at(5.0));
  EXPECT_EQ(m.kinetic, 0.5 * 2.0 * 9.0 + 0.5 * 4.0 * 1.0);
  EXPECT_EQ(m.elastic, 0.5 * 8.0 * 9.0);
  EXPECT_EQ(m.gravitational, 2.0 * 10.0 * 3.0 + 4.0 * 10.0 * 3.0);
  EXPECT_EQ(m.total(), 11.0 + 36.0 + 180.0);
  EXPECT_EQ(m.momentum, (Vec3{2.0, 0.0, 4.0}));
  EXPECT_EQ(m.max_speed, 3.0);
  EXPECT_EQ(m.min_height, 3.0);
}

TEST(Energy, SlackCordHoldsNone) {
  EXPECT_EQ(measure(pair(true), state_at(1.0)).elastic, 0.0);
  EXPECT_EQ(measure(pair(false), state_at(1.0)).elastic, 4.0);
  EXPECT_EQ(measure(pair(true), state_at(5.0)).elastic, 36.0);
}

TEST(Energy, PinnedParticleHasPotentialButNoMotion) {
  Model model = pair(false);
  model.inverse_mass.set(0, 0.0);
  State state = state_at(5.0);
  state.velocity[0] = {};
  const Measures m = measure(model, state);
  EXPECT_EQ(m.kinetic, 2.0);
  EXPECT_EQ(m.momentum, (Vec3{0.0, -4.0, 0.0}));
  EXPECT_EQ(m.max_speed, 1.0);
  EXPECT_EQ(m.gravitational, 180.0);
  EXPECT_EQ(m.elastic, 36.0);
}

TEST(Energy, BallsCountOnceTheyAreLaunched) {
  Model model;
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.balls.push_back({0.5, 2.0, 7, {}, {}, {}});
  State state;
  state.ball_position = {{0.0, 3.0, 0.0}};
  state.ball_velocity = {{4.0, 0.0, 0.0}};
  state.ball_angular_velocity = {{0.0, 0.0, 10.0}};
  state.step = 6;
  EXPECT_EQ(measure(model, state).total(), 0.0);
  EXPECT_EQ(measure(model, state).min_height, 0.0);
  state.step = 7;
  const Measures m = measure(model, state);
  // ½·2·16 + ½·(2/5·2·0.25)·100
  EXPECT_NEAR(m.kinetic, 26.0, 1e-14);
  EXPECT_NEAR(m.gravitational, 60.0, 1e-13);
  EXPECT_EQ(m.momentum, (Vec3{8.0, 0.0, 0.0}));
  EXPECT_EQ(m.max_speed, 4.0);
  EXPECT_EQ(m.min_height, 3.0);
}

TEST(Energy, EmptyModelIsAllZero) {
  const Measures m = measure(Model{}, State{});
  EXPECT_EQ(m.total(), 0.0);
  EXPECT_EQ(m.min_height, 0.0);
}

}  // namespace
}  // namespace aspic
