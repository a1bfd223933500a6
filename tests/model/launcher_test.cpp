#include "model/launcher.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "support/model_building.h"

namespace aspic {
namespace {

// SplitMix64 by its definition, as a sequence that carries its state: the launcher's numbers by index must be
// the same ones.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t state) : state_(state) {}
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

Model built(const LauncherSettings& launcher) {
  ModelSettings settings;
  settings.launchers.push_back(launcher);
  return test::build(settings);
}

TEST(Launcher, NumbersAreThoseOfSplitMix64) {
  // The first output for state 0 is published with the algorithm's reference code.
  EXPECT_EQ(SplitMix64(0).next(), 0xe220a8397b1dcdafull);
  // mix(0) = 0, so seed 0 starts the sequence at state 0.
  SplitMix64 sequence(0);
  for (std::uint64_t i = 0; i < 100; ++i) {
    EXPECT_EQ(launcher_number(0, i), static_cast<double>(sequence.next() >> 11) / 9007199254740992.0);
  }
}

TEST(Launcher, BallsFollowFromSeedAndNumberAlone) {
  LauncherSettings launcher;
  launcher.count = 50;
  const Model one = built(launcher);
  const Model two = built(launcher);
  launcher.count = 10;
  const Model fewer = built(launcher);
  ASSERT_EQ(one.ball_count(), 50u);
  for (std::size_t n = 0; n < 50; ++n) {
    EXPECT_EQ(one.balls[n].initial_position, two.balls[n].initial_position);
    EXPECT_EQ(one.balls[n].initial_velocity, two.balls[n].initial_velocity);
    if (n < 10) {
      EXPECT_EQ(one.balls[n].initial_position, fewer.balls[n].initial_position);
    }
  }
  launcher.seed = 2;
  const Model other = built(launcher);
  EXPECT_NE(one.balls[0].initial_position, other.balls[0].initial_position);
}

TEST(Launcher, ThrowsFromItsBoxTowardsTheOtherAtItsSteps) {
  LauncherSettings launcher;
  launcher.count = 2000;
  launcher.interval = 0.0124;
  ModelSettings settings;
  settings.simulation.timestep = 0.002;
  settings.launchers.push_back(launcher);
  const Model model = test::build(settings);
  Vec3 mean;
  for (std::size_t n = 0; n < model.balls.size(); ++n) {
    const Ball& ball = model.balls[n];
    const Vec3 target = ball.initial_position + (1.0 / launcher.speed_factor) * ball.initial_velocity;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(ball.initial_position[axis], launcher.from.min[axis]);
      EXPECT_LE(ball.initial_position[axis], launcher.from.max[axis]);
      EXPECT_GE(target[axis], launcher.towards.min[axis] - 1e-14);
      EXPECT_LE(target[axis], launcher.towards.max[axis] + 1e-14);
    }
    EXPECT_EQ(ball.launch_step, static_cast<std::uint64_t>(std::llround(static_cast<double>(n) * 6.2)));
    mean = mean + (1.0 / 2000.0) * ball.initial_position;
  }
  // Four standard deviations of the mean of 2,000 uniform numbers over 4 m.
  const Vec3 middle = 0.5 * (launcher.from.min + launcher.from.max);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(mean[axis], middle[axis], 4.0 * 4.0 / std::sqrt(12.0 * 2000.0));
}

TEST(Launcher, ComesAfterTheBallsOfTheFile) {
  ModelSettings settings;
  settings.balls.resize(2);
  settings.launchers.resize(2);
  settings.launchers[0].count = 3;
  settings.launchers[1].count = 4;
  settings.launchers[1].seed = 9;
  const Model model = test::build(settings);
  ASSERT_EQ(model.ball_count(), 9u);
  EXPECT_EQ(model.balls[1].initial_position, settings.balls[1].position);
  EXPECT_EQ(model.balls[5].initial_position, launched_ball(settings.launchers[1], 0, 0.001).initial_position);
  const State state = initial_state(model, Precision::double_);
  EXPECT_EQ(state.ball_position.size(), 9u);
  EXPECT_EQ(state.ball_velocity[2], model.balls[2].initial_velocity);
}

// round(n·interval/h) may exceed every step number: then the ball waits for ever, and is not thrown at once.
TEST(Launcher, BallsBeyondAllStepNumbersAreNeverThrown) {
  LauncherSettings launcher;
  launcher.interval = 1e6;
  EXPECT_EQ(launched_ball(launcher, 0, 1e-14).launch_step, 0u);
  EXPECT_EQ(launched_ball(launcher, 1, 1e-14).launch_step, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(launched_ball(launcher, 9999999, 5e-324).launch_step, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(launched_ball(launcher, 1, 1e-14).launched(std::uint64_t{1} << 53));
  // The last step numbers that double precision tells apart, and the first that 64 bits do not hold.
  launcher.interval = 1.0;
  EXPECT_EQ(launched_ball(launcher, 1, 0x1p-53).launch_step, std::uint64_t{1} << 53);
  EXPECT_EQ(launched_ball(launcher, 1, 0x1p-63).launch_step, std::uint64_t{1} << 63);
  EXPECT_EQ(launched_ball(launcher, 1, 0x1p-64).launch_step, std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace aspic
