// The floating-point environment that all backends compute in.
#include "base/flush_denormals.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <limits>
#include <thread>

namespace aspic {
namespace {

constexpr float least = std::numeric_limits<float>::min();

TEST(FlushDenormals, FlushesOperandsAndResultsAndKeepsTheirSign) {
  volatile float tiny = least / 4, small = least, negative = -least;
  const FlushDenormals flush;
  EXPECT_TRUE(flushes_denormals());
  EXPECT_EQ(tiny * 1e30f, 0.0f);
  const float result = negative * 0.5f;
  EXPECT_EQ(result, 0.0f);
  EXPECT_TRUE(std::signbit(result));
  EXPECT_EQ(small * 1.0f, least);
}

TEST(FlushDenormals, GivesTheCallersEnvironmentBack) {
  ASSERT_FALSE(flushes_denormals());
  volatile float one = 1.0f, little = 1e-10f;
  std::feclearexcept(FE_ALL_EXCEPT);
  std::feraiseexcept(FE_OVERFLOW);
  std::fesetround(FE_UPWARD);
  {
    const FlushDenormals flush;
    EXPECT_EQ(one + little, 1.0f);
    { const FlushDenormals again; }
    EXPECT_TRUE(flushes_denormals());
    volatile float zero = 0.0f;
    volatile float infinite = 1.0f / zero;
    EXPECT_TRUE(std::isinf(infinite));
  }
  EXPECT_GT(one + little, 1.0f);
  std::fesetround(FE_TONEAREST);
  EXPECT_FALSE(flushes_denormals());
  EXPECT_EQ(std::fetestexcept(FE_ALL_EXCEPT & ~(FE_INEXACT | FE_UNDERFLOW)), FE_OVERFLOW);
}

TEST(FlushDenormals, IsInheritedByThreads) {
  bool flushed = false;
  {
    const FlushDenormals flush;
    std::thread([&] { flushed = flushes_denormals(); }).join();
  }
  EXPECT_TRUE(flushed);
  std::thread([&] { flushed = flushes_denormals(); }).join();
  EXPECT_FALSE(flushed);
}

}  // namespace
}  // namespace aspic
