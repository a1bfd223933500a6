// Vectors of lanes that are particles, for files that Highway compiles once for each instruction set.
#if defined(ASPIC_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASPIC_LANES_INL_H
#undef ASPIC_LANES_INL_H
#else
#define ASPIC_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "cpu_parallel/particles.h"
#include "cpu_parallel/springs.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, slice>;
using Float = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
constexpr Tag tag;
constexpr std::size_t lanes = hn::MaxLanes(tag);

struct Vector {
  Float x, y, z;
};

/// Places count modulo 2⁶⁴: a neighbor's may lie in the margin before the first particle.
HWY_INLINE Vector load(const VectorArray& a, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  return {hn::LoadU(tag, a[0].data() + at), hn::LoadU(tag, a[1].data() + at),
          hn::LoadU(tag, a[2].data() + at)};
}
/// The first `count` lanes, zero in the others; reads nothing behind them.
HWY_INLINE Float load_first(const float* from, std::size_t count) {
  if (count >= lanes) return hn::LoadU(tag, from);
  // Below AVX2 a masked load reads all lanes, from aligned addresses alone.
  if constexpr (lanes >= 8) return hn::MaskedLoad(hn::FirstN(tag, count), tag, from);
  float some[lanes] = {};
  for (std::size_t i = 0; i < count; ++i) some[i] = from[i];
  return hn::LoadU(tag, some);
}
HWY_INLINE void store(const Vector& v, VectorArray& a, std::size_t i) {
  hn::StoreU(v.x, tag, a[0].data() + i);
  hn::StoreU(v.y, tag, a[1].data() + i);
  hn::StoreU(v.z, tag, a[2].data() + i);
}
HWY_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector operator*(Float s, const Vector& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE Float dot3(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector chosen(Mask mask, const Vector& yes, const Vector& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

/// The bits of `lanes` particles from `lane` on, a multiple of `lanes`.
HWY_INLINE Mask mask_of(const std::uint16_t& word, std::size_t lane) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&word);  // little-endian
  if constexpr (lanes >= 8) return hn::LoadMaskBits(tag, bytes + lane / 8);
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(word >> lane)};
  return hn::LoadMaskBits(tag, bits);
}

HWY_INLINE Vector gathered(const VectorArray& a, hn::Vec<hn::RebindToSigned<Tag>> i) {
  return {hn::GatherIndex(tag, a[0].data(), i), hn::GatherIndex(tag, a[1].data(), i),
          hn::GatherIndex(tag, a[2].data(), i)};
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
