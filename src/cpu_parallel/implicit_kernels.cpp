// What implicit Euler does particle by particle, without springs.
#include "cpu_parallel/implicit_kernels.h"

#include "cpu_parallel/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/implicit_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "cpu_parallel/lanes-inl.h"
#include "model/integrator.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

// Arrays have room for complete vectors behind the last block: these loops need no separate remainder.

HWY_INLINE Vector load(const BlockVectors& a, std::size_t i) {
  return {hn::Load(tag, a[0].of + i), hn::Load(tag, a[1].of + i), hn::Load(tag, a[2].of + i)};
}
HWY_INLINE void store(const Vector& v, BlockVectors& a, std::size_t i) {
  hn::Store(v.x, tag, a[0].of + i);
  hn::Store(v.y, tag, a[1].of + i);
  hn::Store(v.z, tag, a[2].of + i);
}

bool Residuals(const BlockResidual& at, Range range, const BlockVectors& f, VectorArray& r, BlockVectors& R,
               BlockVectors& free, BlockNumbers& meets) {
  const Float h = hn::Set(tag, at.h), zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  // Rounding of the way and of the distance is far below a thousandth.
  const Float most = hn::Set(tag, at.h * at.h * 1.002f);
  bool any = false;
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t i = range.first + n;
    const Float m = hn::LoadU(tag, at.mass + i), w = hn::LoadU(tag, at.inverse_mass + i);
    const Mask pinned = hn::Eq(w, zero);
    const Vector v = load(*at.start_v, i), none = {zero, zero, zero};
    const Vector total = load(f, n) + (at.held != nullptr ? load(*at.held, i) : none);
    const Vector change = load(*at.trial, i) - v;
    const Vector gained = h * (w * total);
    const Vector fly = v + gained;
    store(chosen(pinned, none, h * total - m * change), r, i);
    store(chosen(pinned, none, change - gained), R, n);
    store(fly, free, n);
    if (at.clearance == nullptr) continue;
    const Mask clear = hn::Lt(hn::Mul(dot3(fly, fly), most), hn::LoadU(tag, at.clearance + i));
    const Mask meeting = hn::Not(hn::Or(clear, pinned));
    hn::Store(hn::IfThenElseZero(meeting, one), tag, meets.of + n);
    any = any || !hn::AllFalse(tag, meeting);
  }
  return any;
}

/// A tree over the `count` first numbers of a block; the rest counts as zero.
template <class Combine>
HWY_INLINE float tree(BlockNumbers& numbers, std::size_t count, const Combine& combine) {
  float* const of = numbers.of;
  for (std::size_t n = count; n < block_size; ++n) of[n] = 0.0f;
  std::size_t half = block_size / 2;
  for (; half >= lanes; half /= 2) {
    for (std::size_t n = 0; n < half; n += lanes)
      hn::Store(combine(hn::Load(tag, of + n), hn::Load(tag, of + n + half)), tag, of + n);
  }
  const hn::CappedTag<float, 1> one;
  for (; half > 0; half /= 2) {
    for (std::size_t n = 0; n < half; ++n)
      hn::Store(combine(hn::Load(one, of + n), hn::Load(one, of + n + half)), one, of + n);
  }
  return of[0];
}

constexpr auto sum = [](auto a, auto b) HWY_ATTR { return hn::Add(a, b); };
constexpr auto larger = [](auto a, auto b) HWY_ATTR { return hn::IfThenElse(hn::Gt(b, a), b, a); };

ResidualShare ShareOf(const BlockVectors& R, const float* inverse_mass, const std::array<float, 3>& fall,
                      std::size_t count) {
  BlockNumbers largest, squared, falling;
  const Vector gained = {hn::Set(tag, fall[0]), hn::Set(tag, fall[1]), hn::Set(tag, fall[2])};
  for (std::size_t n = 0; n < count; n += lanes) {
    const Vector at = load(R, n);
    const Float xy = larger(hn::Abs(at.x), hn::Abs(at.y));
    hn::Store(larger(xy, hn::Abs(at.z)), tag, largest.of + n);
    hn::Store(dot3(at, at), tag, squared.of + n);
    const Mask moves = hn::Ne(hn::LoadU(tag, inverse_mass + n), hn::Zero(tag));
    const Vector after_fall = at + gained;
    hn::Store(hn::IfThenElseZero(moves, dot3(after_fall, after_fall)), tag, falling.of + n);
  }
  return {tree(largest, count, larger), tree(squared, count, sum), tree(falling, count, sum)};
}

void Invert(const std::array<BlockNumbers, 6>& blocks, Range range, LinearSystem& system) {
  const auto product = [](Float a, Float b, Float c, Float d)
                           HWY_ATTR { return hn::Sub(hn::Mul(a, b), hn::Mul(c, d)); };
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const auto at = [&](std::size_t c) HWY_ATTR { return hn::Load(tag, blocks[c].of + n); };
    const Float xx = at(0), yy = at(1), zz = at(2), xy = at(3), xz = at(4), yz = at(5);
    const Float cofactors[6] = {product(yy, zz, yz, yz), product(xx, zz, xz, xz), product(xx, yy, xy, xy),
                                product(xz, yz, xy, zz), product(xy, yz, xz, yy), product(xy, xz, xx, yz)};
    const Float determinant =
        hn::Add(hn::Add(hn::Mul(xx, cofactors[0]), hn::Mul(xy, cofactors[3])), hn::Mul(xz, cofactors[4]));
    const Float d = hn::Div(hn::Set(tag, 1.0f), determinant);
    for (std::size_t c = 0; c < 6; ++c)
      hn::StoreU(hn::Mul(cofactors[c], d), tag, system.inverse[c].data() + range.first + n);
  }
}

void UpdateBlock(LinearSystem& system, Range range, Update how, float alpha) {
  const Float factor = hn::Set(tag, how == Update::prescribed ? 1.0f : alpha), zero = hn::Zero(tag);
  for (std::size_t i = range.first; i < range.first + range.count; i += lanes) {
    Vector r = load(system.r, i);
    if (how == Update::none) {
      store({zero, zero, zero}, system.delta, i);
    } else {
      r = r - factor * load(system.z, i);
      store(r, system.r, i);
    }
    if (how == Update::first || how == Update::further) {
      const Vector step = factor * load(system.p, i);
      store(how == Update::first ? step : load(system.delta, i) + step, system.delta, i);
    }
    const auto inverse = [&](std::size_t c) HWY_ATTR { return hn::LoadU(tag, system.inverse[c].data() + i); };
    const Float xx = inverse(0), yy = inverse(1), zz = inverse(2), xy = inverse(3), xz = inverse(4),
                yz = inverse(5);
    store({dot3({xx, xy, xz}, r), dot3({xy, yy, yz}, r), dot3({xz, yz, zz}, r)}, system.z, i);
  }
}

float Dot(const VectorArray& a, const VectorArray& b, Range range) {
  BlockNumbers products;
  for (std::size_t n = 0; n < range.count; n += lanes)
    hn::Store(dot3(load(a, range.first + n), load(b, range.first + n)), tag, products.of + n);
  return tree(products, range.count, sum);
}

void Turn(LinearSystem& system, Range range, bool first, float beta) {
  const Float factor = hn::Set(tag, beta);
  for (std::size_t i = range.first; i < range.first + range.count; i += lanes) {
    const Vector z = load(system.z, i);
    store(first ? z : z + factor * load(system.p, i), system.p, i);
  }
}

void TryVelocity(LinearSystem& system, VectorArray& trial, Range range, bool onwards, float lambda) {
  const Float factor = hn::Set(tag, lambda);
  for (std::size_t i = range.first; i < range.first + range.count; i += lanes) {
    const Vector base = load(onwards ? trial : system.base, i);
    if (onwards) store(base, system.base, i);
    store(base + factor * load(system.delta, i), trial, i);
  }
}

void Drift(const VectorArray& x, const VectorArray& v, float h, VectorArray& to, Range range) {
  const Float step = hn::Set(tag, h);
  for (std::size_t i = range.first; i < range.first + range.count; i += lanes)
    store(load(x, i) + step * load(v, i), to, i);
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(Residuals);
HWY_EXPORT(ShareOf);
HWY_EXPORT(Invert);
HWY_EXPORT(UpdateBlock);
HWY_EXPORT(Dot);
HWY_EXPORT(Turn);
HWY_EXPORT(TryVelocity);
HWY_EXPORT(Drift);

LinearSystem::LinearSystem(std::size_t count, std::size_t margin)
    : base(vector_array(count, slice)),
      delta(vector_array(count, margin)),
      r(vector_array(count, slice)),
      z(vector_array(count, slice)),
      p(vector_array(count, margin)) {
  for (FloatArray& component : inverse) component = FloatArray(count, slice);
}

bool residuals(const BlockResidual& at, Range range, const BlockVectors& f, VectorArray& r, BlockVectors& R,
               BlockVectors& free, BlockNumbers& meets) {
  return HWY_DYNAMIC_DISPATCH(Residuals)(at, range, f, r, R, free, meets);
}
ResidualShare share_of(const BlockVectors& R, const float* inverse_mass, const std::array<float, 3>& fall,
                       std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(ShareOf)(R, inverse_mass, fall, count);
}
void invert(const std::array<BlockNumbers, 6>& blocks, Range range, LinearSystem& system) {
  HWY_DYNAMIC_DISPATCH(Invert)(blocks, range, system);
}
void update(LinearSystem& system, Range range, Update how, float alpha) {
  HWY_DYNAMIC_DISPATCH(UpdateBlock)(system, range, how, alpha);
}
float dot(const VectorArray& a, const VectorArray& b, Range range) {
  return HWY_DYNAMIC_DISPATCH(Dot)(a, b, range);
}
void turn(LinearSystem& system, Range range, bool first, float beta) {
  HWY_DYNAMIC_DISPATCH(Turn)(system, range, first, beta);
}
void try_velocity(LinearSystem& system, VectorArray& trial, Range range, bool onwards, float lambda) {
  HWY_DYNAMIC_DISPATCH(TryVelocity)(system, trial, range, onwards, lambda);
}
void drift(const VectorArray& x, const VectorArray& v, float h, VectorArray& to, Range range) {
  HWY_DYNAMIC_DISPATCH(Drift)(x, v, h, to, range);
}

}  // namespace aspic::parallel
#endif
