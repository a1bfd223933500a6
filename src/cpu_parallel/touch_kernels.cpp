#include <algorithm>

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/touch_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/lanes-inl.h"
#include "cpu_parallel/touch_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

const hn::RebindToSigned<Tag> index_tag;

HWY_INLINE Vector cross3(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Shares b and c of the nearest place, and whether it is within the face: nearest_place(), the regions asked
/// for last first.
struct Nearest {
  Float b, c;
  Mask face;

  HWY_INLINE void unless(Mask region, Float b_there, Float c_there) {
    b = hn::IfThenElse(region, b_there, b);
    c = hn::IfThenElse(region, c_there, c);
    face = hn::AndNot(region, face);
  }
};

HWY_INLINE Nearest nearest_place(const Vector& P, const Vector& A, const Vector& B, const Vector& C) {
  const Vector ab = B - A, ac = C - A, ap = P - A, bp = P - B, cp = P - C;
  const Float d1 = dot3(ab, ap), d2 = dot3(ac, ap), d3 = dot3(ab, bp), d4 = dot3(ac, bp), d5 = dot3(ab, cp),
              d6 = dot3(ac, cp);
  const Float vc = hn::Sub(hn::Mul(d1, d4), hn::Mul(d3, d2)), vb = hn::Sub(hn::Mul(d5, d2), hn::Mul(d1, d6)),
              va = hn::Sub(hn::Mul(d3, d6), hn::Mul(d5, d4));
  const Float to_b = hn::Sub(d4, d3), to_c = hn::Sub(d5, d6);
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  const auto all = [](Mask a, Mask b, Mask c) { return hn::And(hn::And(a, b), c); };
  const Float q = hn::Div(one, hn::Add(hn::Add(va, vb), vc));
  Nearest at = {hn::Mul(vb, q), hn::Mul(vc, q), hn::Eq(zero, zero)};
  const Float on_bc = hn::Div(to_b, hn::Add(to_b, to_c));
  at.unless(all(hn::Le(va, zero), hn::Ge(to_b, zero), hn::Ge(to_c, zero)), hn::Sub(one, on_bc), on_bc);
  at.unless(all(hn::Le(vb, zero), hn::Ge(d2, zero), hn::Le(d6, zero)), zero, hn::Div(d2, hn::Sub(d2, d6)));
  at.unless(hn::And(hn::Ge(d6, zero), hn::Le(d5, d6)), zero, one);
  at.unless(all(hn::Le(vc, zero), hn::Ge(d1, zero), hn::Le(d3, zero)), hn::Div(d1, hn::Sub(d1, d3)), zero);
  at.unless(hn::And(hn::Ge(d3, zero), hn::Le(d4, d3)), one, zero);
  at.unless(hn::And(hn::Le(d1, zero), hn::Le(d2, zero)), zero, zero);
  return at;
}

void Look(const TouchLanes& batch) {
  const auto in = [](const float* const(&of)[3], std::size_t n) {
    return Vector{hn::LoadU(tag, of[0] + n), hn::LoadU(tag, of[1] + n), hn::LoadU(tag, of[2] + n)};
  };
  const auto out = [](const Vector& v, float* const(&to)[3], std::size_t n) {
    hn::StoreU(v.x, tag, to[0] + n);
    hn::StoreU(v.y, tag, to[1] + n);
    hn::StoreU(v.z, tag, to[2] + n);
  };
  const auto corner = [&](std::size_t c, std::size_t n) {
    const auto i = hn::LoadU(index_tag, batch.corner[c] + n);
    return Vector{hn::GatherIndex(tag, batch.x[0], i), hn::GatherIndex(tag, batch.x[1], i),
                  hn::GatherIndex(tag, batch.x[2], i)};
  };
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  const auto flags = [&](Mask mask, std::int32_t* to) {
    hn::StoreU(hn::ConvertTo(index_tag, hn::IfThenElseZero(mask, one)), index_tag, to);
  };
  for (std::size_t n = 0; n < batch.count; n += lanes) {
    const Vector A = corner(0, n), B = corner(1, n), C = corner(2, n), P = in(batch.P, n);
    const Vector g = cross3(B - A, C - A);
    const Float square = dot3(g, g);
    const Vector N = hn::Div(one, hn::Sqrt(square)) * g;
    const Mask turned = hn::Lt(dot3(in(batch.N_P, n), g), zero);
    const Mask either = hn::Eq(hn::LoadU(tag, batch.opposing + n), zero);
    const Nearest at = nearest_place(P, A, B, C);
    const Vector e = ((P - A) - at.b * (B - A)) - at.c * (C - A);
    flags(hn::And(hn::Gt(square, zero), hn::Or(turned, either)), batch.counts + n);
    flags(at.face, batch.face + n);
    hn::StoreU(at.b, tag, batch.b + n);
    hn::StoreU(at.c, tag, batch.c + n);
    hn::StoreU(hn::Sqrt(dot3(e, e)), tag, batch.L + n);
    hn::StoreU(dot3(e, N), tag, batch.z + n);
    out(e, batch.e, n);
    out(N, batch.N, n);
  }
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(Look);

void look_in_lanes(const TouchLanes& batch) {
  HWY_DYNAMIC_DISPATCH(Look)(batch);
}

}  // namespace aspic::parallel
#endif
