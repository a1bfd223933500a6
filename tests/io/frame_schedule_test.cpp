#include "io/frame_schedule.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aspic {
namespace {

TEST(FrameSchedule, ShowsTheNearestStep) {
  const FrameSchedule schedule(0.001, 0, 4000, 60.0, 1.0);
  ASSERT_EQ(schedule.count(), 241u);
  EXPECT_EQ(schedule.step_of(0), 0u);
  EXPECT_EQ(schedule.step_of(1), 17u);  // 16.67 ms
  EXPECT_EQ(schedule.step_of(2), 33u);  // 33.33 ms
  EXPECT_EQ(schedule.step_of(3), 50u);
  EXPECT_EQ(schedule.step_of(240), 4000u);
}

TEST(FrameSchedule, EndsWithTheLastState) {
  // 0.1 s at 60 a second: 6 intervals; 0.11 s: 6.6, so one more image for the end.
  EXPECT_EQ(FrameSchedule(0.001, 0, 100, 60.0, 1.0).count(), 7u);
  const FrameSchedule odd(0.001, 0, 110, 60.0, 1.0);
  ASSERT_EQ(odd.count(), 8u);
  EXPECT_EQ(odd.step_of(6), 100u);
  EXPECT_EQ(odd.step_of(7), 110u);
}

TEST(FrameSchedule, SlowMotionShowsAStepSeveralTimes) {
  const FrameSchedule schedule(0.01, 10, 20, 60.0, 0.25);
  // 0.1 s of simulation last 0.4 s: 24 intervals.
  ASSERT_EQ(schedule.count(), 25u);
  EXPECT_EQ(schedule.step_of(0), 10u);
  EXPECT_EQ(schedule.step_of(1), 10u);
  for (std::uint64_t f = 1; f < schedule.count(); ++f) {
    EXPECT_GE(schedule.step_of(f), schedule.step_of(f - 1));
    EXPECT_LE(std::abs(static_cast<double>(schedule.step_of(f)) - 10 - static_cast<double>(f) / 2.4),
              0.5 + 1e-12);
  }
}

TEST(FrameSchedule, NoStepsGiveOneImage) {
  const FrameSchedule schedule(0.001, 7, 7, 60.0, 1.0);
  ASSERT_EQ(schedule.count(), 1u);
  EXPECT_EQ(schedule.step_of(0), 7u);
}

TEST(FrameSchedule, AnOpenEndShowsTheSameSteps) {
  const FrameSchedule closed(0.001, 3, 100003, 60.0, 1.5);
  const FrameSchedule open = FrameSchedule::open_ended(0.001, 3, 60.0, 1.5);
  for (std::uint64_t f = 0; f + 1 < closed.count(); ++f) ASSERT_EQ(open.step_of(f), closed.step_of(f)) << f;
  // An hour on, image and step still belong together: nothing adds up.
  EXPECT_EQ(open.step_of(std::uint64_t{60} * 3600), 3u + 5'400'000u);
  EXPECT_GT(open.step_of(std::uint64_t{1} << 51), open.step_of(std::uint64_t{1} << 50));
}

}  // namespace
}  // namespace aspic
