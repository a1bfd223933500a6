#include <gtest/gtest.h>

#include <chrono>

#include "gpu/pass.h"
#include "gpu/pass_profiler.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

class PassProfilerGl : public testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto program = Program::compute(context(), ShaderLibrary(ASPIC_TEST_SHADERS), "count.comp");
    ASSERT_TRUE(program.ok()) << program.error().message();
    program_ = std::move(*program);
    auto visits = Buffer::create(context(), "visits", std::uint64_t{4} * most);
    ASSERT_TRUE(visits.ok());
    visits_ = std::move(*visits);
    visits_.clear();
    program_.set(0, most);
  }
  void dispatch(std::uint32_t count) {
    Pass(program_, {{.binding = 2, .buffer = &visits_}}, ReadBy::compute_pass).dispatch_for(count);
  }
  /// Waits until so many steps' results have been taken in, as the dispatches of kind 0 show: one in each.
  static std::vector<PassTime> wait(PassProfiler& profiler) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    std::vector<PassTime> times;
    while (times.empty() && std::chrono::steady_clock::now() < deadline) times = profiler.times();
    return times;
  }

  static constexpr std::uint32_t most = 1 << 20;
  Program program_;
  Buffer visits_;
};

TEST_F(PassProfilerGl, GivesEachDispatchItsTime) {
  dispatch(most);  // the driver finishes compiling
  // Whatever else the machine does meets any dispatch: the large one takes longer as a rule, not each time.
  int longer = 0;
  for (int attempt = 0; attempt < 15; ++attempt) {
    PassProfiler profiler(context(), {"small", "never", "large"});
    EXPECT_TRUE(profiler.times().empty());
    ASSERT_TRUE(profiler.begin());
    dispatch(64);
    profiler.mark(0);
    dispatch(most);
    profiler.mark(2);
    dispatch(64);
    profiler.mark(0);
    profiler.end();
    const auto times = wait(profiler);
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "small");
    EXPECT_EQ(times[0].dispatches, 2.0);
    EXPECT_EQ(times[1].name, "large");
    EXPECT_EQ(times[1].dispatches, 1.0);
    longer += times[1].milliseconds > times[0].milliseconds ? 1 : 0;
  }
  EXPECT_GT(longer, 7);
}

TEST_F(PassProfilerGl, WaitsForEachPassWhereAsked) {
  PassProfiler profiler(context(), {"small", "never", "large"}, PassStamps::waiting);
  for (std::size_t n = 0; n < 8; ++n) {
    ASSERT_TRUE(profiler.begin());  // nothing is ever out
    dispatch(64);
    profiler.mark(0);
    dispatch(most);
    profiler.mark(2);
    profiler.end();
  }
  const auto times = profiler.times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[1].name, "large");
  EXPECT_EQ(times[1].dispatches, 1.0);
  EXPECT_GT(times[1].milliseconds, 0.0);
  EXPECT_GE(times[1].processor_milliseconds, 0.0);
}

TEST_F(PassProfilerGl, TakesMeansOverTheLastSteps) {
  PassProfiler profiler(context(), {"one", "other"});
  for (std::size_t n = 0; n < 3 * PassProfiler::window; ++n) {
    while (!profiler.begin()) {
    }
    dispatch(64);
    profiler.mark(0);
    // Only the steps of the first third know the other kind: the window has left them behind at the end.
    if (n < PassProfiler::window) {
      dispatch(64);
      profiler.mark(1);
    }
    profiler.end();
    if (n == 9) {
      ASSERT_EQ(wait(profiler).size(), 2u);
    }
  }
  const auto times = wait(profiler);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].dispatches, 1.0);
}

TEST_F(PassProfilerGl, MarksOutsideAStepAndUnfinishedStepsCountForNothing) {
  PassProfiler profiler(context(), {"one", "other"});
  profiler.mark(1);
  profiler.end();
  ASSERT_TRUE(profiler.begin());
  profiler.mark(1);
  ASSERT_TRUE(profiler.begin());
  profiler.mark(0);
  profiler.end();
  profiler.mark(1);
  const auto times = wait(profiler);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].name, "one");
}

TEST_F(PassProfilerGl, LeavesOutAStepThatIsTooLong) {
  PassProfiler profiler(context(), {"one", "other"});
  ASSERT_TRUE(profiler.begin());
  for (std::size_t n = 0; n <= PassProfiler::most_dispatches; ++n) profiler.mark(1);
  profiler.end();
  ASSERT_TRUE(profiler.begin());
  profiler.mark(0);
  profiler.end();
  const auto times = wait(profiler);
  ASSERT_EQ(times.size(), 1u);
  EXPECT_EQ(times[0].name, "one");
}

}  // namespace
}  // namespace aspic::gl
