#include "model/pull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/model_building.h"

namespace aspic {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(RoundedPull, RoundsToThePrecision) {
  const Model model = test::particles({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  const Pull pull{1, {0.1, -0.2, 1e-50}, 1.0 / 3.0, 1e30 / 7.0};
  EXPECT_EQ(*rounded_pull(model, pull, Precision::double_), pull);
  const Pull single = *rounded_pull(model, pull, Precision::single);
  EXPECT_EQ(single, (Pull{1,
                          {double{0.1f}, double{-0.2f}, 0.0},
                          double{1.0f / 3.0f},
                          static_cast<double>(static_cast<float>(1e30 / 7.0))}));
}

TEST(RoundedPull, ReadsMinusZeroAsPlusZero) {
  const Model model = test::particles({{0, 0, 0}}, {{0, 0, 0}});
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const Pull taken = *rounded_pull(model, Pull{0, {-0.0, -0.0, -0.0}, -0.0, -0.0}, precision);
    for (const double value :
         {taken.anchor.x, taken.anchor.y, taken.anchor.z, taken.stiffness, taken.damping}) {
      EXPECT_EQ(value, 0.0);
      EXPECT_FALSE(std::signbit(value));
    }
  }
  // Too small for single precision, and negative.
  EXPECT_FALSE(std::signbit(rounded_pull(model, Pull{0, {-1e-60, 0, 0}, 1, 1}, Precision::single)->anchor.x));
}

TEST(RoundedPull, RefusesWithFigures) {
  const Model model = test::particles({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}});
  const auto refused = [&](const Pull& pull, Precision precision = Precision::single) {
    const auto taken = rounded_pull(model, pull, precision);
    EXPECT_FALSE(taken.ok());
    if (taken.ok()) return std::string();
    EXPECT_EQ(taken.error().code, ErrorCode::usage);
    return taken.error().message();
  };
  EXPECT_NE(refused({2, {0, 0, 0}, 1, 1}).find("2 particles"), std::string::npos);
  EXPECT_NE(refused({1, {0, NAN, 0}, 1, 1}).find("not finite"), std::string::npos);
  EXPECT_NE(refused({1, {0, 0, 0}, infinity, 1}).find("not finite"), std::string::npos);
  EXPECT_NE(refused({1, {0, 0, 0}, 1, NAN}, Precision::double_).find("not finite"), std::string::npos);
  EXPECT_NE(refused({1, {0, 0, 0}, -3, 1}).find("-3"), std::string::npos);
  EXPECT_NE(refused({1, {0, 0, 0}, 1, -0.5}).find("negative"), std::string::npos);
  // Finite as a double, not as a float.
  refused({1, {1e39, 0, 0}, 1, 1});
  EXPECT_TRUE(rounded_pull(model, Pull{1, {1e39, 0, 0}, 1, 1}, Precision::double_).ok());
}

}  // namespace
}  // namespace aspic
