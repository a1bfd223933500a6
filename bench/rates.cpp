#include "rates.h"

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "../bench/rates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace aspic::bench::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::ScalableTag<float>;
using Float = hn::Vec<Tag>;
constexpr Tag tag;

/// Keeps a value from being known or left out.
HWY_INLINE void used(Float& value) {
#if HWY_TARGET == HWY_EMU128
  asm volatile("" : "+m"(value.raw));
#else
  asm volatile("" : "+x"(value.raw));
#endif
}

template <class Apply>
std::size_t in_rounds(std::size_t rounds, const Apply& apply) {
  Float a = hn::Set(tag, 1.1f), b = a, c = a, d = a, e = a, f = a, g = a, h = a;
  for (std::size_t n = 0; n < rounds; ++n) {
    for (Float* const value : {&a, &b, &c, &d, &e, &f, &g, &h}) {
      *value = apply(*value);
      used(*value);
    }
  }
  return rounds * 8 * hn::Lanes(tag);
}

std::size_t repeated(Operation operation, std::size_t rounds) {
  const Float one = hn::Set(tag, 1.000001f), little = hn::Set(tag, 1e-7f);
  switch (operation) {
    case Operation::add:
      return in_rounds(rounds, [&](Float x) { return hn::Add(x, little); });
    case Operation::multiply:
      return in_rounds(rounds, [&](Float x) { return hn::Mul(x, one); });
    case Operation::fused:
      return in_rounds(rounds, [&](Float x) { return hn::MulAdd(x, one, little); });
    case Operation::root:
      return in_rounds(rounds, [&](Float x) { return hn::Sqrt(x); });
    case Operation::quotient:
      return in_rounds(rounds, [&](Float x) { return hn::Div(one, x); });
    case Operation::reciprocal_root:
      return in_rounds(rounds, [&](Float x) { return hn::ApproximateReciprocalSqrt(x); });
  }
  return 0;
}

}  // namespace
}  // namespace aspic::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::bench {

HWY_EXPORT(repeated);

std::size_t repeat(Operation operation, std::size_t rounds) {
  return HWY_DYNAMIC_DISPATCH(repeated)(operation, rounds);
}

}  // namespace aspic::bench
#endif
