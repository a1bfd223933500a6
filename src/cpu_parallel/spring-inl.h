// The force of a spring in each lane, for files that Highway compiles once for each instruction set.
#if defined(ASPIC_SPRING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ASPIC_SPRING_INL_H
#undef ASPIC_SPRING_INL_H
#else
#define ASPIC_SPRING_INL_H
#endif

#include "cpu_parallel/body_force-inl.h"
#include "cpu_parallel/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// Stiffness, damping and rest length of a spring in each lane.
struct Spring {
  Float k, c, r;
};

/// Lengths and tensions s = k(L − r) + c((v·e)·q), q = 1/L, of springs with e = xₐ − x_b and v = vₐ − v_b
/// (SpringTension of physics/springs/law.h); spring i has the constants of[i % size]. All are treated in
/// parallel, since one after the other they would fill the processor's scheduler with waiting operations.
/// Not a number for a spring of no length.
template <std::size_t size, std::size_t springs>
HWY_INLINE void evaluate_tensions(const Vector (&e)[springs], const Vector (&v)[springs],
                                  const Spring (&of)[size], Float (&length)[springs], Float (&q)[springs],
                                  Float (&s)[springs]) {
  Float along[springs];
  for (std::size_t i = 0; i < springs; ++i) length[i] = dot3(e[i], e[i]);
  for (std::size_t i = 0; i < springs; ++i) length[i] = hn::Sqrt(length[i]);
  for (std::size_t i = 0; i < springs; ++i) along[i] = dot3(v[i], e[i]);
  for (std::size_t i = 0; i < springs; ++i) q[i] = hn::Div(hn::Set(tag, 1.0f), length[i]);
  for (std::size_t i = 0; i < springs; ++i)
    s[i] = hn::Mul(of[i % size].k, hn::Sub(length[i], of[i % size].r));
  for (std::size_t i = 0; i < springs; ++i) along[i] = hn::Mul(of[i % size].c, hn::Mul(along[i], q[i]));
  for (std::size_t i = 0; i < springs; ++i) s[i] = hn::Add(s[i], along[i]);
}

/// What springs take off the forces on their ends a: factor·e, the factor being s·q; and their lengths.
template <std::size_t size, std::size_t springs>
HWY_INLINE void evaluate_springs(const Vector (&e)[springs], const Vector (&v)[springs],
                                 const Spring (&of)[size], Float (&factor)[springs],
                                 Float (&length)[springs]) {
  Float q[springs];
  evaluate_tensions(e, v, of, length, q, factor);
  for (std::size_t i = 0; i < springs; ++i) factor[i] = hn::Mul(factor[i], q[i]);
}

HWY_INLINE Vector body_force(const ForceInput& input, std::size_t i) {
  return BodyForce(*input.body_force).at(hn::LoadU(tag, input.mass + i), load(input.at->v, i));
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
