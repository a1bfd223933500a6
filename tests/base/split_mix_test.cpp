#include "base/split_mix.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

// The published sequence of seed 1234567.
TEST(SplitMix64, GivesThePublishedNumbers) {
  SplitMix64 random(1234567);
  EXPECT_EQ(random(), 6457827717110365317ull);
  EXPECT_EQ(random(), 3203168211198807973ull);
  EXPECT_EQ(random(), 9817491932198370423ull);
  EXPECT_EQ(random(), 4593380528125082431ull);
  EXPECT_EQ(random(), 16408922859458223821ull);
}

}  // namespace
}  // namespace aspic
