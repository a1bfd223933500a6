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
    EXPECT_TRUE(made.ok()) << made.error().message;
    return made ? std::move(made).value() : Program();
  }
  Buffer buffer(std::uint64_t bytes) {
    auto made = Buffer::create(context(), "test", bytes);
    EXPECT_TRUE(made.ok()) << made.error().message;
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
    const Pass pass(program, {{.binding = 2, .buffer = &visits}}, Reader::read_back);
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
  Pass(program, {{.binding = 2, .buffer = &visits}}, Reader::read_back).dispatch_for(0);
  EXPECT_EQ(visits.download_items<std::uint32_t>(1).front(), 0u);
}

}  // namespace
}  // namespace aspic::gl
