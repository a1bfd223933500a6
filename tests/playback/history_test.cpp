#include "playback/history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aspic::test {
namespace {

constexpr std::uint64_t plenty = std::uint64_t{1} << 30;

Setup setup_with(double timestep) {
  Setup setup;
  setup.settings.simulation.timestep = timestep;
  return setup;
}

State state_at(std::uint64_t step, std::size_t particles = 4) {
  State s;
  s.step = step;
  const double x = static_cast<double>(step);
  s.position.assign(particles, {x, -0.5 * x, 0.25});
  s.velocity.assign(particles, {1.0, 2.0, x});
  return s;
}

/// Two stretches: steps 0…100 at 10 ms with keyframes every 20, then 1000…1040 at 1 ms.
History two_stretches() {
  History h(plenty);
  h.begin(setup_with(0.01), state_at(0));
  for (std::uint64_t step = 20; step <= 100; step += 20) h.add_keyframe(state_at(step));
  h.begin(setup_with(0.001), state_at(1000));
  h.reach(1040);
  return h;
}

TEST(History, PackingAStateKeepsEveryBit) {
  State s = state_at(7);
  s.position[2] = {static_cast<double>(0.1f), -0.0, static_cast<double>(1e-42f)};
  s.ball_position = {{1.0, 2.0, 3.0}};
  s.ball_velocity = {{4.0, 5.0, 6.0}};
  s.ball_angular_velocity = {{7.0, 8.0, -9.0}};
  const State back = unpack(pack(s));
  EXPECT_EQ(back, s);
  EXPECT_EQ(state_hash(back), state_hash(s));
  EXPECT_TRUE(std::signbit(back.position[2].y));
  State exact = s;
  exact.precision = Precision::double_;
  exact.position[1].x = 0.1;
  EXPECT_EQ(unpack(pack(exact)), exact);
  EXPECT_EQ(state_hash(unpack(pack(exact))), state_hash(exact));
}

TEST(History, StepsBackAndForthAcrossAChangeOfSetup) {
  const History h = two_stretches();
  EXPECT_EQ(h.begin_moment(), (Moment{0, 0}));
  EXPECT_EQ(h.end_moment(), (Moment{1, 1040}));
  EXPECT_EQ(h.before({1, 1001}), (Moment{1, 1000}));
  // Step 100 of the first stretch and step 1000 of the second are the same moment.
  EXPECT_EQ(h.before({1, 1000}), (Moment{0, 99}));
  EXPECT_EQ(h.after({0, 98}), (Moment{0, 99}));
  EXPECT_EQ(h.after({0, 99}), (Moment{1, 1000}));
  EXPECT_EQ(h.after({0, 100}), (Moment{1, 1001}));
  EXPECT_EQ(h.after({1, 1040}), std::nullopt);
  EXPECT_EQ(h.before({0, 0}), std::nullopt);
  EXPECT_EQ(h.changes(), std::vector<double>{1.0});
}

TEST(History, WalkingBackAndForthMeetsTheSameMoments) {
  const History h = two_stretches();
  std::vector<Moment> forth = {h.begin_moment()};
  while (const auto next = h.after(forth.back())) forth.push_back(*next);
  EXPECT_EQ(forth.size(), 141u);
  std::vector<Moment> back = {h.end_moment()};
  while (const auto next = h.before(back.back())) back.push_back(*next);
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(back, forth);
}

TEST(History, FindsMomentsByTime) {
  const History h = two_stretches();
  EXPECT_EQ(h.nearest(-3.0), (Moment{0, 0}));
  EXPECT_EQ(h.nearest(0.236), (Moment{0, 24}));
  EXPECT_EQ(h.nearest(1.0), (Moment{1, 1000}));
  EXPECT_EQ(h.nearest(1.0124), (Moment{1, 1012}));
  EXPECT_EQ(h.nearest(99.0), (Moment{1, 1040}));
  EXPECT_EQ(h.time({0, 24}), 24 * 0.01);
}

TEST(History, KeyframesAreTheNewestAtOrBefore) {
  const History h = two_stretches();
  EXPECT_EQ(h.keyframe({0, 19}).step, 0u);
  EXPECT_EQ(h.keyframe({0, 20}).step, 20u);
  EXPECT_EQ(h.keyframe({0, 99}).step, 80u);
  EXPECT_EQ(h.keyframe({1, 1040}).step, 1000u);
  EXPECT_EQ(h.keyframes_before({1, 1040}, 1), (Moment{1, 1000}));
  EXPECT_EQ(h.keyframes_before({1, 1040}, 3), (Moment{0, 60}));
  EXPECT_EQ(h.keyframes_before({1, 1040}, 50), (Moment{0, 0}));
}

TEST(History, InputsHoldFromTheirStepOn) {
  History h(plenty);
  h.begin(setup_with(0.01), state_at(0));
  const Inputs first = {.pulls = {{1, {1.0, 2.0, 3.0}, 10.0, 1.0}}}, second = {.channels = {20.0}};
  h.set_inputs(5, first);
  h.reach(9);
  h.set_inputs(9, second);
  h.set_inputs(9, {});
  h.reach(20);
  EXPECT_EQ(h.inputs_at({0, 4}), Inputs());
  EXPECT_EQ(h.inputs_at({0, 5}), first);
  EXPECT_EQ(h.inputs_at({0, 8}), first);
  EXPECT_EQ(h.inputs_at({0, 9}), Inputs()) << "of two changes at one step the later counts";
  EXPECT_EQ(h.next_input_change({0, 0}), 5u);
  EXPECT_EQ(h.next_input_change({0, 5}), 9u);
  EXPECT_EQ(h.next_input_change({0, 9}), std::nullopt);
  h.truncate({0, 9});
  EXPECT_EQ(h.inputs_at({0, 9}), first) << "what was to happen from there on is forgotten";
  EXPECT_EQ(h.end_moment(), (Moment{0, 9}));
}

TEST(History, TruncatingForgetsLaterStretchesAndKeyframes) {
  History h = two_stretches();
  const std::uint64_t bytes = h.bytes();
  h.truncate({0, 50});
  EXPECT_EQ(h.end_moment(), (Moment{0, 50}));
  EXPECT_EQ(h.keyframe({0, 50}).step, 40u);
  EXPECT_EQ(h.keyframe_count(), 3u);
  EXPECT_LT(h.bytes(), bytes);
  h.begin(setup_with(0.002), state_at(250));
  EXPECT_EQ(h.end_moment(), (Moment{1, 250}));
}

TEST(History, ChangesWithoutAStepBetweenLeaveOneStretch) {
  History h(plenty);
  h.begin(setup_with(0.01), state_at(0));
  h.add_keyframe(state_at(10));
  for (int i = 1; i <= 5; ++i) h.begin(setup_with(0.001 * i), state_at(10));
  EXPECT_EQ(h.end_moment().stretch, 1u);
  EXPECT_EQ(h.stretch(1).timestep(), 0.005);
  EXPECT_EQ(h.keyframe_count(), 3u);
}

TEST(History, DropsTheOldestBeyondItsMemory) {
  const std::uint64_t one = pack(state_at(0)).bytes();
  History h(5 * one);
  h.begin(setup_with(0.01), state_at(0));
  for (std::uint64_t step = 10; step <= 30; step += 10) h.add_keyframe(state_at(step));
  h.begin(setup_with(0.02), state_at(15));
  for (std::uint64_t step = 20; step <= 40; step += 10) h.add_keyframe(state_at(step));
  EXPECT_LE(h.bytes(), 5 * one);
  EXPECT_EQ(h.begin_moment(), (Moment{0, 30}));
  h.add_keyframe(state_at(50));
  EXPECT_EQ(h.begin_moment(), (Moment{1, 15})) << "stretches keep their numbers";
  EXPECT_EQ(h.before({1, 15}), std::nullopt);
  // What is larger than all memory for it is kept alone.
  h.begin(setup_with(0.02), state_at(60, 4000));
  EXPECT_EQ(h.keyframe_count(), 1u);
  EXPECT_EQ(h.begin_moment(), (Moment{2, 60}));
}

TEST(History, ThinningKeepsTheStepsAndOnlyThenDropsThem) {
  History h = two_stretches();
  const std::uint64_t all = h.bytes();
  h.thin(all);
  EXPECT_EQ(h.bytes(), all);
  h.thin(all / 2);
  EXPECT_LE(h.bytes(), all / 2);
  EXPECT_GT(h.keyframe_count(), 1u);
  EXPECT_EQ(h.begin_moment(), (Moment{0, 0}));
  EXPECT_EQ(h.end_moment(), (Moment{1, 1040}));
  EXPECT_EQ(h.keyframe({0, 100}).step % 40, 0u);
  h.thin(1);
  EXPECT_EQ(h.keyframe_count(), 1u);
  EXPECT_EQ(h.begin_moment(), (Moment{1, 1000}));
}

TEST(History, MomentsOfAnOldRunAreNoneOfTheNew) {
  History h = two_stretches();
  const Moment old = h.end_moment();
  h.clear();
  EXPECT_TRUE(h.empty());
  EXPECT_EQ(h.bytes(), 0u);
  h.begin(setup_with(0.001), state_at(old.step));
  EXPECT_NE(h.end_moment(), old);
}

}  // namespace
}  // namespace aspic::test
