#include "physics/reductions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace aspic::physics {
namespace {

/// The definition again, as a recursion on one block: halves of 128, 64, … are folded onto each other.
float folded(const std::vector<float>& block, std::size_t begin, std::size_t stride) {
  if (stride == 256) return begin < block.size() ? block[begin] : 0.0f;
  return folded(block, begin, 2 * stride) + folded(block, begin + stride, 2 * stride);
}
float block_sum(const std::vector<float>& values) {
  // Element i is combined with i + 128 first, so seen from the root the last fold is by stride 1.
  return folded(values, 0, 1);
}

TEST(TreeSum, OfOneBlockFoldsHalves) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  for (const std::size_t count : {2u, 7u, 128u, 129u, 255u, 256u}) {
    std::vector<float> values(count);
    for (float& v : values) v = any(random) * std::pow(10.0f, any(random) * 4.0f);
    EXPECT_EQ(tree_sum(values), block_sum(values)) << count;
  }
}

TEST(TreeSum, OfManyBlocksIsTheSumOfTheirSums) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  for (const std::size_t count : {257u, 1000u, 65536u, 70000u}) {
    std::vector<float> values(count), level;
    for (float& v : values) v = any(random);
    level = values;
    while (level.size() > 1) {
      std::vector<float> next;
      for (std::size_t first = 0; first < level.size(); first += 256) {
        next.push_back(
            block_sum({level.begin() + static_cast<std::ptrdiff_t>(first),
                       level.begin() + static_cast<std::ptrdiff_t>(std::min(level.size(), first + 256))}));
      }
      level = next;
    }
    EXPECT_EQ(tree_sum(values), level.front()) << count;
  }
}

TEST(TreeSum, OfNothingIsZero) {
  EXPECT_EQ(tree_sum(std::vector<float>{}), 0.0f);
  EXPECT_EQ(tree_sum(std::vector<double>{3.5}), 3.5);
}

TEST(TreeMax, FindsTheLargestWhereverItStands) {
  for (const std::size_t at : {0u, 255u, 256u, 299u}) {
    std::vector<double> values(300, 1.0);
    values[at] = 2.0;
    EXPECT_EQ(tree_max(values), 2.0);
  }
}

// Blocks of 256 from zero, then the blocks' sums: written out for counts around the blocks' ends.
TEST(PartnerSum, GoesByBlocks) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  for (const std::size_t count : {1u, 2u, 255u, 256u, 257u, 511u, 512u, 513u, 5000u}) {
    std::vector<float> values(count);
    for (float& value : values) value = number(random);
    physics::PartnerSum<float> sum(0.0f);
    for (const float value : values) sum.add(value);
    std::vector<float> blocks;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 256 == 0) blocks.push_back(0.0f);
      blocks.back() = blocks.back() + values[i];
    }
    float expected = blocks.front();
    for (std::size_t b = 1; b < blocks.size(); ++b) expected = expected + blocks[b];
    EXPECT_EQ(sum.total(), expected) << count;
  }
  EXPECT_EQ(physics::PartnerSum<float>(0.0f).total(), 0.0f);
}

}  // namespace
}  // namespace aspic::physics
