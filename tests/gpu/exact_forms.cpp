#include "gpu/exact_forms.h"

#include <bit>
#include <cmath>

namespace aspic::testing {

// What GLSL has and C++ has not. No anonymous namespace: a set of defines leaves some functions unused.
namespace glsl {

using uint = std::uint32_t;
using std::abs;
struct vec2 {
  float x, y;
  vec2(float first, float second) : x(first), y(second) {}
};
#define precise

inline uint floatBitsToUint(float x) {
  return std::bit_cast<uint>(x);
}
inline float uintBitsToFloat(uint bits) {
  return std::bit_cast<float>(bits);
}

int fault = 0;

/// Near zero, infinite or no number: what is not nudged.
inline bool special_value(float x) {
  const uint size = std::bit_cast<uint>(x) & 0x7fffffffu;
  return size < 16u || size >= 0x7f7ffff0u;
}

/// The sum of doubles rounded to odd: rounding that to single precision gives the exact sum's rounding (Boldo
/// and Melquiond, 2008).
inline float fma_of_doubles(float a, float b, float c) {
  const double product = static_cast<double>(a) * static_cast<double>(b);
  const double addend = static_cast<double>(c);
  const double sum = product + addend;
  const double rest = sum - product;
  const double lost = (product - (sum - rest)) + (addend - rest);
  auto bits = std::bit_cast<std::int64_t>(sum);
  if (lost != 0.0 && (bits & 1) == 0) bits += (lost > 0.0) == (sum > 0.0) ? 1 : -1;
  return static_cast<float>(std::bit_cast<double>(bits));
}

namespace emulated {
#define ASPIC_FMA fma_of_doubles
#include "gpu/exact_forms-inl.h"
#undef ASPIC_FMA
}  // namespace emulated

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
#endif
namespace fused {
#define ASPIC_FMA std::fma
#include "gpu/exact_forms-inl.h"
#undef ASPIC_FMA
}  // namespace fused
#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace glsl

int& device_fault = glsl::fault;

bool has_fused_fma() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return true;
#endif
}

std::span<const ExactForm, 3> exact_forms() {
  if (has_fused_fma()) return glsl::fused::forms;
  return glsl::emulated::forms;
}

float emulated_fma(float a, float b, float c) {
  return glsl::fma_of_doubles(a, b, c);
}

}  // namespace aspic::testing
