// The corrected quotients and roots of shaders/compute/exact.glsl, as C++, on a processor with faults.
#include "gpu/exact_forms.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "base/split_mix.h"

namespace aspic::testing {
namespace {

using Limits = std::numeric_limits<float>;

class ExactForms : public ::testing::Test {
 protected:
  void TearDown() override { device_fault = 0; }
};

constexpr std::size_t slow = 0, one_step = 1, two_steps = 2;

/// Processors without fma try every sixteenth mantissa: doubles in its place take twenty times as long.
std::uint32_t stride() {
  return has_fused_fma() ? 1 : 16;
}

std::uint32_t bits_of(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

bool same(float a, float b) {
  return bits_of(a) == bits_of(b) || (std::isnan(a) && std::isnan(b));
}

float flushed(float x) {
  return std::fpclassify(x) == FP_SUBNORMAL ? std::copysign(0.0f, x) : x;
}

/// a/b as IEEE 754 has it, with denormal operands and results flushed: of mantissas, so that rounding knows
/// no denormal numbers.
float quotient(float a, float b) {
  a = flushed(a), b = flushed(b);
  if (!std::isnormal(a) || !std::isnormal(b)) return a / b;
  int a_exponent, b_exponent;
  const float q = std::frexp(a, &a_exponent) / std::frexp(b, &b_exponent);
  const int exponent = a_exponent - b_exponent;
  if (std::ilogb(q) + exponent < -126) return std::copysign(0.0f, q);
  return std::ldexp(q, exponent);
}

void expect_exact(const ExactForm& form, float a, float b) {
  const float q = form.div(a, b), y = form.rcp(b);
  EXPECT_TRUE(same(q, quotient(a, b)))
      << form.name << ", fault " << device_fault << ": " << a << " / " << b << " gave " << q;
  EXPECT_TRUE(same(y, quotient(1.0f, b)))
      << form.name << ", fault " << device_fault << ": 1 / " << b << " gave " << y;
}

void expect_exact(const ExactForm& form, float x) {
  const float root = form.sqrt(x);
  EXPECT_TRUE(same(root, std::sqrt(flushed(x))))
      << form.name << ", fault " << device_fault << ": √" << x << " gave " << root;
}

TEST_F(ExactForms, TwoStepsAreExactForEveryMantissa) {
  for (int fault = -2; fault <= 2; ++fault) {
    device_fault = fault;
    const WrongForms wrong = exact_forms()[two_steps].count_wrong(stride());
    EXPECT_EQ(wrong.reciprocals, 0u) << fault;
    EXPECT_EQ(wrong.roots, 0u) << fault;
    EXPECT_EQ(wrong.reciprocals_of_roots, 0u) << fault;
  }
}

// What the canary has to find on a device before it chooses this form.
TEST_F(ExactForms, OneStepHasExceptions) {
  const ExactForm& form = exact_forms()[one_step];
  const auto reciprocal_is_wrong = [&](std::uint32_t bits) {
    const float b = std::bit_cast<float>(bits);
    return !same(form.rcp(b), 1.0f / b);
  };
  if (stride() == 1) {
    device_fault = 1;
    const WrongForms wrong = form.count_wrong(1);
    EXPECT_EQ(wrong.reciprocals, 32u);
    EXPECT_EQ(wrong.roots, 2u);
    EXPECT_EQ(wrong.reciprocals_of_roots, 64u);
  }
  device_fault = -1;
  EXPECT_TRUE(reciprocal_is_wrong(0x3fffffff));
  device_fault = 2;
  EXPECT_TRUE(reciprocal_is_wrong(0x3fffffff));
  EXPECT_TRUE(reciprocal_is_wrong(0x3f869913));
  const float x = std::bit_cast<float>(0x406e9372u);
  EXPECT_FALSE(same(form.sqrt(x), std::sqrt(x)));
  device_fault = 0;
  EXPECT_FALSE(reciprocal_is_wrong(0x3fffffff));
}

TEST_F(ExactForms, SlowFormIsExactForOneMantissaInAHundred) {
  for (const int fault : {-4, -2, -1, 1, 2, 5}) {
    device_fault = fault;
    const WrongForms wrong = exact_forms()[slow].count_wrong(101);
    EXPECT_EQ(wrong.reciprocals + wrong.roots + wrong.reciprocals_of_roots, 0u) << fault;
  }
}

/// Random operands, quotients next to the middle of two floats, and roots likewise.
class Operands {
 public:
  explicit Operands(std::uint64_t seed) : random_(seed) {}
  float any() { return std::bit_cast<float>(static_cast<std::uint32_t>(random_() >> 32)); }
  float scaled(float mantissa, int low, int high) {
    const auto span = static_cast<std::uint64_t>(high - low + 1);
    const float size = std::ldexp(mantissa, low + static_cast<int>((random_() >> 32) * span >> 32));
    return (random_() >> 63) != 0 ? -size : size;
  }
  /// A number with its leading bit at 2^23.
  std::uint32_t mantissa() { return 0x800000u | static_cast<std::uint32_t>(random_() >> 41); }
  /// a and b with a/b next to the middle of two floats.
  std::array<float, 2> hard() {
    const std::uint32_t b = mantissa();
    const std::uint64_t product = ((std::uint64_t{mantissa()} << 1) | 1) * b;
    const auto a = static_cast<float>((product >> (std::bit_width(product) - 24)) + (random_() >> 63));
    return {a, static_cast<float>(b)};
  }

 private:
  SplitMix64 random_;
};

TEST_F(ExactForms, QuotientsAreExactNextToMidpointsAndAtTheEdgesOfTheRange) {
  for (int fault = -2; fault <= 2; ++fault) {
    device_fault = fault;
    Operands operands(static_cast<std::uint64_t>(fault + 2));
    for (const std::size_t which : {slow, one_step, two_steps}) {
      // One step needs a device on which it has no exception.
      if (which == one_step && fault != 0) continue;
      const ExactForm& form = exact_forms()[which];
      for (int n = 0; n < 20000; ++n) {
        const auto [a, b] = operands.hard();
        expect_exact(form, operands.scaled(a, -23, -23), operands.scaled(b, -23, -23));
        expect_exact(form, operands.scaled(a, -86, -84), operands.scaled(b, 38, 40));  // −62 and 62
        expect_exact(form, operands.scaled(a, 38, 40), operands.scaled(b, -86, -84));
        expect_exact(form, operands.scaled(a, -149, 104), operands.scaled(b, -149, 104));
        const float x = operands.any();
        expect_exact(form, x, operands.any());
        expect_exact(form, x);
        if (HasFailure()) return;
      }
    }
  }
}

TEST_F(ExactForms, SpecialValuesKeepTheirMeaning) {
  std::vector<float> values = {0.0f,
                               1.0f,
                               3.0f,
                               Limits::infinity(),
                               Limits::quiet_NaN(),
                               Limits::denorm_min(),
                               Limits::min() - Limits::denorm_min(),
                               Limits::min(),
                               Limits::max(),
                               0x1p-62f,
                               0x1.fffffep-63f,
                               0x1p62f,
                               0x1.fffffep61f,
                               0x1p-126f,
                               0x1.fffffep126f,
                               0x1p127f};
  for (std::size_t i = 0, n = values.size(); i < n; ++i) values.push_back(-values[i]);
  for (const int fault : {-1, 0, 1}) {
    device_fault = fault;
    for (const ExactForm& form : exact_forms()) {
      if (&form == &exact_forms()[one_step] && fault != 0) continue;
      for (const float a : values) {
        expect_exact(form, a);
        for (const float b : values) expect_exact(form, a, b);
      }
    }
  }
}

// a·b is nearly half a unit in the last place of c, as in the last step of a quotient that is hard to round.
TEST_F(ExactForms, EmulatedFmaRoundsOnce) {
  Operands operands(7);
  int twice = 0;
  for (int n = 0; n < 200000; ++n) {
    const auto mantissa = static_cast<float>(operands.mantissa());
    const float a = operands.scaled(mantissa, -47, -46), b = 0x1p23f / mantissa;
    const auto c = static_cast<float>(operands.mantissa()) * 0x1p-23f;
    const float fused = std::fma(a, b, c);
    ASSERT_EQ(emulated_fma(a, b, c), fused) << a << ", " << b << ", " << c;
    const double sum = static_cast<double>(a) * static_cast<double>(b) + static_cast<double>(c);
    twice += static_cast<float>(sum) != fused;
  }
  EXPECT_GT(twice, 1000) << "too few cases tell it from two roundings";
}

}  // namespace
}  // namespace aspic::testing
