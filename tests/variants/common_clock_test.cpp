#include "variants/common_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/steps.h"

namespace aspic::test {
namespace {

TEST(CommonClock, ShowsTheNearestStepOfEachRun) {
  const double steps[] = {0.001, 0.0015, 0.0007, 0.016};
  std::vector<Span> runs;
  for (const double h : steps) runs.push_back({h, static_cast<std::uint64_t>(std::llround(1.0 / h))});
  const double fps = 60.0, speed = 0.5;
  const CommonClock clock(runs, fps, speed);
  EXPECT_EQ(clock.count(), 121u);  // 2 s shown at 60 a second
  for (std::size_t run = 0; run < runs.size(); ++run) {
    std::uint64_t before = 0;
    for (std::uint64_t f = 0; f < clock.count(); ++f) {
      const std::uint64_t step = clock.step_of(run, f);
      EXPECT_GE(step, before);
      EXPECT_LE(step, runs[run].last_step);
      before = step;
      const double off = static_cast<double>(step) * steps[run] - static_cast<double>(f) * speed / fps;
      EXPECT_LE(std::abs(off), 0.5 * steps[run] * (1.0 + 1e-9)) << "run " << run << ", image " << f;
    }
    EXPECT_EQ(before, runs[run].last_step);
  }
}

TEST(CommonClock, OfEqualStepsIsThatOfARunAlone) {
  const FrameSchedule alone(0.001, 0, 503, 60.0, 1.0);
  const CommonClock clock({{0.001, 503}, {0.001, 503}}, 60.0, 1.0);
  ASSERT_EQ(clock.count(), alone.count());
  for (std::uint64_t f = 0; f < alone.count(); ++f)
    for (std::size_t run = 0; run < 2; ++run) EXPECT_EQ(clock.step_of(run, f), alone.step_of(f));
}

TEST(CommonClock, RunsLastAsLongAsTheFirst) {
  SimulationSettings first, other;
  first.timestep = 0.001;
  other.timestep = 0.003;
  EXPECT_EQ(as_long_as(first, 4000, first).value(), 4000u);
  EXPECT_EQ(as_long_as(first, 4000, other).value(), 1333u);
  other.timestep = 1e-300;
  EXPECT_FALSE(as_long_as(first, 4000, other).ok());
}

TEST(CommonClock, NearestStepsAreWithinHalfAStepAndWhatCanBeCounted) {
  EXPECT_EQ(nearest_step(0.0149, 0.01), 1u);
  EXPECT_EQ(nearest_step(0.0151, 0.01), 2u);
  EXPECT_EQ(nearest_step(-1.0, 0.01), 0u);
  EXPECT_EQ(nearest_step(1e300, 0.01), std::uint64_t{1} << 62);
}

}  // namespace
}  // namespace aspic::test
