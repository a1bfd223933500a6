#include "app/units.h"

#include <gtest/gtest.h>

#include <limits>

namespace aspic::app {
namespace {

TEST(Units, NumbersHaveAPrefixInsteadOfAPowerOfTen) {
  EXPECT_EQ(with_prefix(88260.0, "J"), "88.26 kJ");
  EXPECT_EQ(with_prefix(88260.0, "J", 3), "88.3 kJ");
  EXPECT_EQ(with_prefix(5164.6, "N·s"), "5.165 kN·s");
  EXPECT_EQ(with_prefix(-0.0123, "J"), "-12.3 mJ");
  EXPECT_EQ(with_prefix(999.96, "J"), "1 kJ");
  EXPECT_EQ(with_prefix(999.9, "J"), "999.9 J");
  EXPECT_EQ(with_prefix(1000.0, "J"), "1 kJ");
  EXPECT_EQ(with_prefix(1.0, "J"), "1 J");
  EXPECT_EQ(with_prefix(0.0, "J"), "0 J");
  EXPECT_EQ(with_prefix(-0.0, "J"), "0 J");
  EXPECT_EQ(with_prefix(3e20, "J"), "3e+08 TJ");
  EXPECT_EQ(with_prefix(std::numeric_limits<double>::infinity(), "J"), "inf J");
}

TEST(Units, RoundingIsNothing) {
  EXPECT_EQ(without_noise(3e-7, 5000.0), 0.0);
  EXPECT_EQ(without_noise(-3e-7, 5000.0), 0.0);
  EXPECT_EQ(without_noise(0.5, 5000.0), 0.5);
  EXPECT_EQ(without_noise(1e-12, 0.0), 1e-12);
}

}  // namespace
}  // namespace aspic::app
