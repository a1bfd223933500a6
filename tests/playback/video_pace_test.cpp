#include "playback/video_pace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "playback/pacer.h"
#include "playback/samples.h"

namespace aspic::test {
namespace {

constexpr double h = 0.001;

TEST(VideoPace, TakesTheImagesOfAVideoMadeHeadless) {
  const FrameSchedule headless(h, 0, 2000, 60.0, 1.0);
  VideoPace pace(60.0);
  std::vector<std::uint64_t> steps;
  // A run that goes as far as it may at once.
  for (std::uint64_t step = 0; step <= 2000; step = pace.next_step()) {
    ASSERT_EQ(pace.take(step, h, 1.0), 1u);
    EXPECT_EQ(pace.take(step, h, 1.0), 0u) << "none twice";
    steps.push_back(step);
  }
  ASSERT_EQ(steps.size(), headless.count());
  for (std::uint64_t f = 0; f < headless.count(); ++f) EXPECT_EQ(steps[f], headless.step_of(f));
}

TEST(VideoPace, StepsBetweenImagesChangeNothing) {
  VideoPace pace(60.0);
  std::uint64_t images = 0;
  for (std::uint64_t step = 0; step <= 2000; ++step) images += pace.take(step, h, 1.0);
  EXPECT_EQ(images, 121u);
}

TEST(VideoPace, SlowMotionShowsAStepForSeveralImages) {
  VideoPace pace(50.0);
  // 0.02 s of a video show 0.25 ms: four images for each step, up to where the nearest step changes.
  EXPECT_EQ(pace.take(7, h, 0.0125), 2u);
  std::uint64_t images = 0;
  for (std::uint64_t step = 8; step < 108; ++step) images += pace.take(step, h, 0.0125);
  EXPECT_EQ(images, 400u);
}

TEST(VideoPace, BackInTimeBeginsAnewAtOnce) {
  VideoPace pace(50.0);
  EXPECT_EQ(pace.take(0, h, 1.0), 1u);
  EXPECT_EQ(pace.take(20, h, 1.0), 1u);
  EXPECT_EQ(pace.take(33, h, 1.0), 0u);
  EXPECT_EQ(pace.take(11, h, 1.0), 1u);
  EXPECT_EQ(pace.next_step(), 31u);
  EXPECT_EQ(pace.take(0, h, 1.0), 1u) << "reset";
  EXPECT_EQ(pace.next_step(), 20u);
}

TEST(VideoPace, AJumpAheadBeginsAnewAtOnce) {
  VideoPace pace(50.0);
  EXPECT_EQ(pace.take(0, h, 1.0), 1u);
  EXPECT_EQ(pace.take(500, h, 1.0), 1u);
  EXPECT_EQ(pace.next_step(), 520u);
}

TEST(VideoPace, AnotherSpeedCountsFromTheLastImage) {
  VideoPace pace(50.0);
  EXPECT_EQ(pace.take(40, h, 1.0), 1u);
  EXPECT_EQ(pace.take(45, h, 2.0), 0u);
  EXPECT_EQ(pace.next_step(), 80u);
  // Slower than what has passed already: the next image is due now.
  EXPECT_EQ(pace.take(60, h, 0.5), 1u);
  EXPECT_EQ(pace.next_step(), 70u);
}

TEST(VideoPace, AnotherTimeStepKeepsTheTimes) {
  VideoPace pace(50.0);
  EXPECT_EQ(pace.take(0, h, 1.0), 1u);
  EXPECT_EQ(pace.take(20, h, 1.0), 1u);
  EXPECT_EQ(pace.take(30, h, 1.0), 0u);
  // 30 ms are 15 steps of 2 ms; the next image is due at 40 ms.
  EXPECT_EQ(pace.take(15, 2.0 * h, 1.0), 0u);
  EXPECT_EQ(pace.next_step(), 20u);
}

TEST(VideoPace, BeginsAnewWhenTold) {
  VideoPace pace(50.0);
  EXPECT_EQ(pace.take(0, h, 1.0), 1u);
  pace.restart();
  EXPECT_EQ(pace.take(0, h, 1.0), 1u);
}

TEST(Slowness, SaysHowLongASecondTakesAndWhatWouldDo) {
  EXPECT_EQ(slowness(0.4, 10), "the solver does not keep up");
  EXPECT_EQ(slowness(0.02, 0), "1 s takes about 50 s here");
  EXPECT_EQ(slowness(0.00045, 64), "1 s takes about 38 min here; try 6 particles an edge");
}

TEST(Slowness, IsNotSaidOfARunThatIsAsFastAsWasAsked) {
  SimulationSettings settings;
  Pacer pacer;
  // Steps that are not done pile up: late.
  for (int i = 0; i < 10; ++i) pacer.steps_due(0.1, settings, 0);
  ASSERT_TRUE(pacer.late());
  EXPECT_FALSE(pacer.falls_short(0.0)) << "nothing was measured";
  EXPECT_TRUE(pacer.falls_short(0.5));
  EXPECT_FALSE(pacer.falls_short(0.98));
  EXPECT_FALSE(pacer.falls_short(1.04));
  pacer.set_speed(2.0);
  EXPECT_TRUE(pacer.falls_short(1.04));
}

TEST(Limits, TheLeastOfThemHolds) {
  SimulationSettings settings;
  Pacer pacer;
  pacer.set_pace(Pace::steps_per_frame);
  const auto due = [&](std::uint64_t step) {
    pacer.drop_due();
    return pacer.steps_due(0.0, settings, step);
  };
  const auto pace = static_cast<std::uint64_t>(settings.steps_per_frame);
  ASSERT_GT(pace, 4u);
  EXPECT_EQ(due(100), pace);
  EXPECT_FALSE(pacer.limit().has_value());
  pacer.limit(Hold::comparison, 103);
  EXPECT_EQ(due(100), 3u);
  pacer.limit(Hold::encoder, 101);
  EXPECT_EQ(due(100), 1u);
  EXPECT_EQ(due(105), 0u) << "it is beyond already";
  pacer.limit(Hold::encoder, std::nullopt);
  EXPECT_EQ(pacer.limit(), 103u) << "each takes back its own alone";
  pacer.limit(Hold::comparison, std::nullopt);
  EXPECT_EQ(due(100), pace);
}

TEST(Limits, ARunThatCatchesUpGoesToItsLimitWhateverThePace) {
  SimulationSettings settings;
  Pacer pacer;
  pacer.catch_up(true);
  EXPECT_EQ(pacer.steps_due(0.0, settings, 7), 0u) << "without a limit it goes nowhere";
  pacer.limit(Hold::comparison, 1000);
  EXPECT_EQ(pacer.steps_due(0.0, settings, 7), 993u);
  EXPECT_EQ(pacer.steps_due(0.0, settings, 1000), 0u);
  pacer.catch_up(false);
  EXPECT_EQ(pacer.steps_due(0.0, settings, 7), 0u);
}

TEST(Limits, AVideoSeesEachStateAndSpeedBeforeTheRunGoesOn) {
  SimulationSettings settings;
  Pacer pacer;
  pacer.set_pace(Pace::steps_per_frame);
  const auto due = [&] { return pacer.steps_due(0.0, settings, 0); };
  pacer.limit(Hold::video, 500);
  EXPECT_GT(due(), 0u);
  pacer.drop_due();
  EXPECT_EQ(due(), 0u) << "the run was put to another state";
  EXPECT_GT(due(), 0u);
  pacer.set_speed(2.0);
  EXPECT_EQ(due(), 0u);
  EXPECT_GT(due(), 0u);
  pacer.set_speed(2.0);
  EXPECT_GT(due(), 0u) << "the same";
  pacer.limit(Hold::video, std::nullopt);
  pacer.drop_due();
  EXPECT_GT(due(), 0u) << "without a video it goes on at once";
}

TEST(SampleSteps, RunsOfDifferentTimeStepsHavePointsAtTheSameTimes) {
  EXPECT_EQ(next_sample_step(0, 0.001), 20u);
  EXPECT_EQ(next_sample_step(19, 0.001), 20u);
  EXPECT_EQ(next_sample_step(20, 0.001), 40u);
  EXPECT_EQ(next_sample_step(20, 0.001, 4), 80u);
  EXPECT_EQ(next_sample_step(7, 1.0 / 60.0), 8u) << "every step where that is about as long";
  EXPECT_EQ(next_sample_step(7, 1.0 / 60.0, 2), 8u);
  const double h = 0.0013;
  std::uint64_t step = 0;
  for (int i = 1; i <= 1000; ++i) {
    step = next_sample_step(step, h);
    EXPECT_LE(std::abs(static_cast<double>(step) * h - 0.02 * i), 0.5 * h * (1.0 + 1e-9));
  }
  EXPECT_GT(next_sample_step(std::uint64_t{1} << 60, 0.001), std::uint64_t{1} << 60);
}

}  // namespace
}  // namespace aspic::test
