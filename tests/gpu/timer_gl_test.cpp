#include <chrono>

#include "gpu/pass.h"
#include "gpu/timer.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

class TimerGl : public testing::GlTest {};

TEST_F(TimerGl, MeasuresDispatchesInTheirOrder) {
  const auto program = Program::compute(context(), ShaderLibrary(ASPIC_TEST_SHADERS), "count.comp");
  ASSERT_TRUE(program.ok()) << program.error().message;
  constexpr std::uint32_t count = 1 << 18;
  auto visits = Buffer::create(context(), "visits", count * 4);
  ASSERT_TRUE(visits.ok());
  visits->clear();
  program->set(0, count);
  const Pass pass(*program, {{.binding = 2, .buffer = &*visits}}, Reader::compute_pass);

  Timer timer(context());
  EXPECT_EQ(timer.poll(), std::nullopt);
  EXPECT_EQ(timer.wait(), std::nullopt);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(timer.begin());
    pass.dispatch_for(count);
    timer.end();
  }
  EXPECT_EQ(timer.pending(), 3u);
  std::uint64_t total = 0;
  for (int i = 0; i < 3; ++i) {
    const auto nanoseconds = timer.wait();
    ASSERT_TRUE(nanoseconds.has_value());
    EXPECT_GT(*nanoseconds, 0u);
    total += *nanoseconds;
  }
  // The measurements follow one another, so that together they last no longer than the wait for them.
  const std::chrono::nanoseconds passed = std::chrono::steady_clock::now() - start;
  EXPECT_LE(total, static_cast<std::uint64_t>(passed.count()));
  EXPECT_EQ(timer.pending(), 0u);
}

TEST_F(TimerGl, RefusesMoreThanItsCapacityUntilOneIsRead) {
  Timer timer(context());
  for (std::size_t i = 0; i < Timer::capacity; ++i) {
    ASSERT_TRUE(timer.begin());
    timer.end();
  }
  EXPECT_FALSE(timer.begin());
  timer.end();
  EXPECT_EQ(timer.pending(), Timer::capacity);
  // The device gets there without being waited for.
  std::optional<std::uint64_t> polled;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!polled && std::chrono::steady_clock::now() < deadline) polled = timer.poll();
  ASSERT_TRUE(polled.has_value());
  EXPECT_TRUE(timer.begin());
  timer.end();
  while (timer.wait()) {
  }
}

}  // namespace
}  // namespace aspic::gl
