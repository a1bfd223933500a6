#include "gpu/pass.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

namespace aspic::gl {
namespace {

TEST(GroupsFor, CoverTheItemsWithinTheLimits) {
  for (const std::uint32_t size : {1u, 64u, 256u}) {
    for (const std::uint64_t groups :
         {1ull, 2ull, 65534ull, 65535ull, 65536ull, 65537ull, 131070ull, 131071ull, 4000000ull}) {
      for (const std::uint64_t count : {groups * size - size + 1, groups * size}) {
        const GroupCount got = groups_for(static_cast<std::uint32_t>(count), size);
        const std::uint64_t covered = std::uint64_t{got.x} * got.y;
        EXPECT_LE(got.x, max_groups_x);
        EXPECT_LE(got.y, max_groups_x);
        EXPECT_GE(covered, groups) << count;
        EXPECT_LT(covered - groups, got.y) << count;
      }
    }
  }
  EXPECT_EQ(groups_for(0, 64), (GroupCount{0, 0}));
  EXPECT_EQ(groups_for(65535 * 64, 64), (GroupCount{65535, 1}));
  EXPECT_EQ(groups_for(65535 * 64 + 1, 64), (GroupCount{32768, 2}));
}

TEST(BarrierBits, FollowFromTheReaders) {
  EXPECT_EQ(barrier_bits(ReadBy::compute_pass), GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::uniform), GLbitfield{GL_UNIFORM_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::vertex_draw),
            GLbitfield{GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::indirect), GLbitfield{GL_COMMAND_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::read_back), GLbitfield{GL_BUFFER_UPDATE_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::copy), GLbitfield{GL_BUFFER_UPDATE_BARRIER_BIT});
  EXPECT_EQ(barrier_bits(ReadBy::compute_pass | ReadBy::indirect),
            GLbitfield{GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT});
}

}  // namespace
}  // namespace aspic::gl
