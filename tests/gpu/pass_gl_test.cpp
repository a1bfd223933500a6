#include <algorithm>
#include <numeric>

#include "gpu/pass.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

class PassGl : public testing::GlTest {
 protected:
  const ShaderLibrary library_{ASPIC_TEST_SHADERS};

  Program compile(const char* path, std::vector<Define> defines = {}) {
    auto made = Program::compute(context(), library_, path, defines);
    EXPECT_TRUE(made.ok()) << made.error().message();
    return made ? std::move(made).value() : Program();
  }
  Buffer buffer(std::uint64_t bytes) {
    auto made = Buffer::create(context(), "test", bytes);
    EXPECT_TRUE(made.ok()) << made.error().message();
    return made ? std::move(made).value() : Buffer();
  }
};

TEST_F(PassGl, VisitsEachItemOnceInOneAndTwoDimensions) {
  // A group of one invocation makes the second dimension begin at 65,536 items.
  const Program program = compile("count.comp", {{"ASPIC_GROUP_SIZE", "1"}});
  for (const std::uint32_t count : {1u, 65535u, 65536u, 131071u, 200001u}) {
    Buffer visits = buffer(count * 4ull);
    visits.clear();
    program.set(0, count);
    const Pass pass(program, {{.binding = 2, .buffer = &visits}}, ReadBy::read_back);
    pass.dispatch_for(count);
    const auto got = visits.download_items<std::uint32_t>(count);
    EXPECT_EQ(std::ranges::count(got, 1u), count);
  }
}

TEST_F(PassGl, DoesNothingForNoItems) {
  const Program program = compile("count.comp");
  Buffer visits = buffer(4);
  visits.clear();
  program.set(0, 1u);
  Pass(program, {{.binding = 2, .buffer = &visits}}, ReadBy::read_back).dispatch_for(0);
  EXPECT_EQ(visits.download_items<std::uint32_t>(1).front(), 0u);
}

TEST_F(PassGl, NextPassAndIndirectDispatchSeeWhatWasWritten) {
  constexpr std::uint32_t count = 1000;
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 1u);
  Buffer a = buffer(std::uint64_t{4} * count);
  Buffer b = buffer(std::uint64_t{4} * count);
  a.upload_items(numbers);
  const Program twice = compile("double_items.comp", {{"ASPIC_GROUP_SIZE", "64"}});
  twice.set(0, count);
  // The two buffers take turns: bindings come with each dispatch.
  const Pass pass(twice, {}, ReadBy::compute_pass | ReadBy::read_back);
  const Binding forth[] = {{.binding = 0, .buffer = &a}, {.binding = 1, .buffer = &b}};
  const Binding back[] = {{.binding = 0, .buffer = &b}, {.binding = 1, .buffer = &a}};
  for (int i = 0; i < 5; ++i) {
    pass.dispatch_for(count, forth);
    pass.dispatch_for(count, back);
  }
  for (std::uint32_t& n : numbers) n *= 1024;
  EXPECT_EQ(a.download_items<std::uint32_t>(count), numbers);

  // Three groups of 64 reach 192 items, with the arguments written on the device.
  Buffer arguments = buffer(16);
  const Program writer = compile("arguments.comp");
  writer.set(0, 3u);
  Pass(writer, {{.binding = 0, .buffer = &arguments}}, ReadBy::indirect).dispatch_for(1);
  b.clear();
  pass.dispatch_indirect(arguments, 4, forth);
  const auto got = b.download_items<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(got[i], i < 192 ? 2 * numbers[i] : 0u) << i;
}

TEST_F(PassGl, BindsARangeOfABuffer) {
  const std::uint64_t step = std::max(256u, context().info().limits.storage_offset_alignment);
  Buffer visits = buffer(3 * step);
  visits.clear();
  const Program program = compile("count.comp");
  program.set(0, 4u);
  Pass(program, {{.binding = 2, .buffer = &visits, .offset = step, .bytes = step}}, ReadBy::read_back)
      .dispatch_for(4);
  const auto got = visits.download_items<std::uint32_t>(3 * step / 4);
  for (std::size_t i = 0; i < got.size(); ++i)
    ASSERT_EQ(got[i], i >= step / 4 && i < step / 4 + 4 ? 1u : 0u) << i;
}

}  // namespace
}  // namespace aspic::gl
