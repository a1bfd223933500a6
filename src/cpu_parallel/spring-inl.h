// The force of a spring in each lane, for files that Highway compiles once for each instruction set.
#if defined(ASPIC_SPRING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASPIC_SPRING_INL_H
#undef ASPIC_SPRING_INL_H
#else
#define ASPIC_SPRING_INL_H
#endif

#include "cpu_parallel/kernels.h"
#include "cpu_parallel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// Stiffness, damping and rest length of a spring in each lane.
struct Spring {
  Float k, c, r;
};

/// What a spring takes off the force on its end a, (s·q)·e with e = xₐ − x_b and v = vₐ − v_b, and its
/// length; in exact arithmetic not a number where it has none.
struct Pull {
  Float factor;  ///< of e
  Float length;
};

/// a·b of fast arithmetic.
HWY_INLINE Float fused_dot3(const Vector& a, const Vector& b) {
  return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}

/// 1/√a in fast arithmetic. An estimate of n bits has 2n − 1 after a Newton step: x86 gives at least 11.
HWY_INLINE Float fast_root(Float a) {
  Float q = hn::ApproximateReciprocalSqrt(a);
  for (int step = 0; step < (HWY_ARCH_X86 ? 1 : 2); ++step)
    q = hn::Mul(hn::Mul(hn::Set(tag, 0.5f), q), hn::NegMulAdd(hn::Mul(a, q), q, hn::Set(tag, 3.0f)));
  return q;
}

/// k − q·(k·r − c·((v·e)·q)) with q = 1/|e|. A spring shorter than 1e-15 m counts as that long: e = 0 gives
/// no force and nothing that is not finite.
HWY_INLINE Pull fast_pull(const Vector& e, const Vector& v, const Spring& of) {
  const Float square = hn::Max(fused_dot3(e, e), hn::Set(tag, 1e-30f));
  const Float q = fast_root(square);
  const Float inner = hn::NegMulAdd(of.c, hn::Mul(fused_dot3(v, e), q), hn::Mul(of.k, of.r));
  return {hn::NegMulAdd(q, inner, of.k), hn::Mul(square, q)};
}

template <Arithmetic arithmetic>
HWY_INLINE Pull pull(const Vector& e, const Vector& v, const Spring& of) {
  if constexpr (arithmetic == Arithmetic::fast) return fast_pull(e, v, of);
  const Float L = hn::Sqrt(dot3(e, e));
  const Float q = hn::Div(hn::Set(tag, 1.0f), L);
  const Float s = hn::Add(hn::Mul(of.k, hn::Sub(L, of.r)), hn::Mul(of.c, hn::Mul(dot3(v, e), q)));
  return {hn::Mul(s, q), L};
}

HWY_INLINE Vector weight_of(const ForceInput& input, std::size_t i) {
  const Float m = hn::LoadU(tag, input.mass + i);
  return {hn::Mul(m, hn::Set(tag, input.gravity[0])), hn::Mul(m, hn::Set(tag, input.gravity[1])),
          hn::Mul(m, hn::Set(tag, input.gravity[2]))};
}

/// Places as in load() of particles.
HWY_INLINE Vector load(const Forces& forces, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  return {hn::LoadU(tag, forces.component[0] + at), hn::LoadU(tag, forces.component[1] + at),
          hn::LoadU(tag, forces.component[2] + at)};
}
HWY_INLINE void store(const Vector& f, const Forces& forces, std::size_t i) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  hn::StoreU(f.x, tag, forces.component[0] + at);
  hn::StoreU(f.y, tag, forces.component[1] + at);
  hn::StoreU(f.z, tag, forces.component[2] + at);
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
