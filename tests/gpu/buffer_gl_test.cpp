#include <glad/gl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <numeric>

#include "gpu/buffer.h"
#include "support/gl_fixture.h"

namespace aspic::gl {
namespace {

using ::testing::HasSubstr;

class BufferGl : public testing::GlTest {};

TEST_F(BufferGl, GivesBackWhatItWasGiven) {
  std::vector<std::uint32_t> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 7u);
  auto buffer = Buffer::of(context(), "numbers", numbers);
  ASSERT_TRUE(buffer.ok()) << buffer.error().message();
  EXPECT_EQ(buffer->bytes(), 400u);
  EXPECT_EQ(buffer->download_items<std::uint32_t>(100), numbers);
  const std::uint32_t pair[] = {1, 2};
  buffer->upload_items(pair, 98);
  numbers[98] = 1, numbers[99] = 2;
  EXPECT_EQ(buffer->download_items<std::uint32_t>(3, 97),
            std::vector<std::uint32_t>(numbers.begin() + 97, numbers.end()));
  auto other = Buffer::create(context(), "other", 12);
  ASSERT_TRUE(other.ok());
  other->clear();
  EXPECT_EQ(other->download_items<std::uint32_t>(3), std::vector<std::uint32_t>(3, 0));
}

TEST_F(BufferGl, RefusesWhatExceedsTheBlockSize) {
  const std::uint64_t held = context().bytes_held();
  const std::uint64_t limit = context().info().limits.storage_block_bytes;
  const auto refused = Buffer::create(context(), "spring list", limit + 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(refused.error().message(), HasSubstr("\"spring list\""));
  EXPECT_THAT(refused.error().message(), HasSubstr(std::to_string(limit + 1)));
  EXPECT_THAT(refused.error().message(), HasSubstr(std::to_string(limit)));
  EXPECT_THAT(refused.error().message(), HasSubstr("Make the scene smaller"));
  const auto absurd = Buffer::create(context(), "absurd", ~0ull);
  EXPECT_FALSE(absurd.ok());
  const auto uniform = Buffer::create(context(), "classes", context().info().limits.uniform_block_bytes + 1,
                                      BufferKind::uniform);
  ASSERT_FALSE(uniform.ok());
  EXPECT_THAT(uniform.error().message(), HasSubstr("uniform buffer"));
  EXPECT_EQ(context().bytes_held(), held);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(BufferGl, SaysWhenASoftwareDeviceHasNoMemoryLeft) {
  // A software device takes its memory from the process, whose address space can be closed for a moment.
  const std::uint64_t held = context().bytes_held();
  const std::uint64_t size = context().info().limits.storage_block_bytes;
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const rlimit closed = {size / 4, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &closed), 0);
  const auto refused = Buffer::create(context(), "too much", size);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(refused.error().message(), HasSubstr("has no memory for the storage buffer \"too much\""));
  EXPECT_EQ(context().bytes_held(), held);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  // The debug context heard of it too.
  EXPECT_GE(forgive_errors(), 1);
}

TEST_F(BufferGl, CountsTheBytesHeld) {
  const std::uint64_t before = context().bytes_held();
  {
    auto made = Buffer::create(context(), "a", 1000);
    ASSERT_TRUE(made.ok());
    EXPECT_EQ(context().bytes_held(), before + 1000);
    Buffer moved = std::move(made).value();
    EXPECT_EQ(context().bytes_held(), before + 1000);
    auto second = Buffer::create(context(), "b", 24);
    ASSERT_TRUE(second.ok());
    EXPECT_EQ(context().bytes_held(), before + 1024);
    const std::uint32_t id = second->id();
    moved = std::move(second).value();
    EXPECT_EQ(moved.id(), id);
    EXPECT_EQ(context().bytes_held(), before + 24);
  }
  EXPECT_EQ(context().bytes_held(), before);
}

TEST_F(BufferGl, TakesNoBytesAtAll) {
  auto empty = Buffer::create(context(), "empty", 0);
  ASSERT_TRUE(empty.ok());
  EXPECT_NE(empty->id(), 0u);
  EXPECT_EQ(empty->bytes(), 0u);
  empty->clear();
  empty->upload({});
  EXPECT_TRUE(empty->download_items<float>(0).empty());
  empty->bind(BufferKind::storage, 0);
}

}  // namespace
}  // namespace aspic::gl
