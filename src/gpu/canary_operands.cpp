// The operands on which a device's arithmetic is judged.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/split_mix.h"
#include "gpu/canary.h"

namespace aspic::gl {
namespace {

class Random {
 public:
  std::uint64_t bits() { return random_(); }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>((bits() >> 32) * n >> 32); }
  /// A mantissa of 24 bits, the highest set.
  std::uint32_t mantissa() { return 0x800000u | below(0x800000u); }
  /// A number of any sign with an exponent in [low, high].
  float number(int low, int high) {
    const int exponent = low + static_cast<int>(below(static_cast<std::uint32_t>(high - low + 1)));
    const float size = std::ldexp(static_cast<float>(mantissa()), exponent - 23);
    return (bits() & 1) != 0 ? -size : size;
  }

 private:
  SplitMix64 random_{0x6173706963ull};
};

void add_notable(std::vector<CanaryOperands>& cases) {
  using Limits = std::numeric_limits<float>;
  const float notable[] = {1.0f,
                           2.0f,
                           3.0f,
                           7.0f,
                           10.0f,
                           0.1f,
                           1.0f / 3.0f,
                           0.5f,
                           1.0f + Limits::epsilon(),
                           1.0f - Limits::epsilon() / 2,
                           2.0f - Limits::epsilon(),
                           16777215.0f,
                           16777216.0f,
                           0x1p-64f,
                           0x1p64f,
                           0x1p126f,
                           0x1.fffffep126f,
                           0x1p127f,
                           Limits::max(),
                           Limits::min(),
                           0x1.fffffep-126f,
                           Limits::denorm_min(),
                           0x1.8p-149f * 2,
                           Limits::min() - Limits::denorm_min(),
                           0x1p-127f,
                           0x1.000002p-126f};
  std::size_t next = 0;
  for (const float a : notable)
    for (const float b : notable) {
      const float c = notable[(next += 7) % std::size(notable)];
      cases.push_back({a, b, c});
      cases.push_back({-a, b, c});
    }
}

/// The 24 leading bits, as many as a float keeps.
std::uint64_t leading_bits(std::uint64_t product) {
  return product >> std::max(static_cast<int>(std::bit_width(product)) - 24, 0);
}

/// Quotients next to the middle of two floats: a ≈ M·b with an odd M of 25 bits.
void add_hard_quotients(std::vector<CanaryOperands>& cases, Random& random) {
  for (int i = 0; i < 4096; ++i) {
    const std::uint64_t middle = (static_cast<std::uint64_t>(random.mantissa()) << 1) | 1;
    const std::uint64_t b = random.mantissa();
    const std::uint64_t product = middle * b;
    const auto a = static_cast<float>(leading_bits(product) + (random.bits() & 1));
    // Every eighth pair lies where the divisor's reciprocal is denormal, every eighth has a denormal
    // quotient.
    const int a_exponent = i % 8 == 0 ? 103 : i % 8 == 1 ? -110 : 0;
    const int b_exponent = i % 8 == 0 ? 103 : i % 8 == 1 ? 20 : static_cast<int>(random.below(40)) - 43;
    cases.push_back(
        {std::ldexp(a, a_exponent), std::ldexp(static_cast<float>(b), b_exponent), random.number(-3, 3)});
  }
}

/// Roots next to the middle of two floats, and next to floats.
void add_hard_roots(std::vector<CanaryOperands>& cases, Random& random) {
  for (int i = 0; i < 4096; ++i) {
    const std::uint64_t root =
        (static_cast<std::uint64_t>(random.mantissa()) << 1) | static_cast<std::uint64_t>(i & 1);
    const std::uint64_t square = root * root;
    const auto rounded = static_cast<float>(leading_bits(square) + (random.bits() & 1));
    const int exponent = static_cast<int>(random.below(240)) - 140;
    cases.push_back({std::ldexp(rounded, exponent), random.number(-3, 3), random.number(-3, 3)});
  }
}

/// Sums that cancel a product's leading bits, so that a fused a·b + c differs.
void add_cancellations(std::vector<CanaryOperands>& cases, Random& random) {
  for (int i = 0; i < 2048; ++i) {
    const float a = random.number(-10, 10);
    const float b = random.number(-10, 10);
    const float product = a * b;
    cases.push_back({a, b, i % 2 == 0 ? -product : std::nextafter(-product, 0.0f)});
  }
}

}  // namespace

std::vector<CanaryOperands> canary_operands() {
  std::vector<CanaryOperands> cases;
  Random random;
  add_notable(cases);
  add_hard_quotients(cases, random);
  add_hard_roots(cases, random);
  add_cancellations(cases, random);
  for (int i = 0; i < 4096; ++i)
    cases.push_back({random.number(-20, 20), random.number(-20, 20), random.number(-20, 20)});
  for (int i = 0; i < 4096; ++i)
    cases.push_back({random.number(-149, 127), random.number(-149, 127), random.number(-149, 127)});
  return cases;
}

}  // namespace aspic::gl
