#include "cpu_parallel/kernels.h"

// Highway compiles this file once for each of these.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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

HWY_INLINE Vector load(const VectorArray& a, std::size_t i) {
  return {hn::LoadU(tag, a[0].data() + i), hn::LoadU(tag, a[1].data() + i), hn::LoadU(tag, a[2].data() + i)};
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

/// Constants of springs, one in each lane.
struct Spring {
  Float k, c, r, slack, nothing;  // as in Direction
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

/// (k − q·(k·r − c·((v·e)·q)))·e with q = 1/|e|. A spring shorter than 1e-15 m counts as that long: e = 0
/// gives no force and nothing that is not finite.
HWY_INLINE Vector fast_spring(const Vector& e, const Vector& v, const Spring& of) {
  const Float square = hn::Max(fused_dot3(e, e), hn::Set(tag, 1e-30f));
  const Float q = fast_root(square);
  const Float pull = hn::NegMulAdd(of.c, hn::Mul(fused_dot3(v, e), q), hn::Mul(of.k, of.r));
  const Mask slack = hn::Lt(hn::Mul(square, q), of.slack);
  return hn::IfThenZeroElse(slack, hn::NegMulAdd(q, pull, of.k)) * e;
}

/// What a spring takes off the force on its particle: ((s·q)·e), or `nothing` where it has no length or is
/// slack.
template <Arithmetic arithmetic>
HWY_INLINE Vector spring(const Vector& e, const Vector& v, const Spring& of) {
  if constexpr (arithmetic == Arithmetic::fast) return fast_spring(e, v, of);
  const auto& [k, c, r, slack, nothing] = of;
  const Float L = hn::Sqrt(dot3(e, e));
  const Float q = hn::Div(hn::Set(tag, 1.0f), L);
  const Float s = hn::Add(hn::Mul(k, hn::Sub(L, r)), hn::Mul(c, hn::Mul(dot3(v, e), q)));
  const Mask idle = hn::Or(hn::Eq(L, hn::Zero(tag)), hn::Lt(L, slack));
  return chosen(idle, {nothing, nothing, nothing}, hn::Mul(s, q) * e);
}

HWY_INLINE Vector weight_of(const ForceInput& input, std::size_t i) {
  const Float m = hn::LoadU(tag, input.mass + i);
  return {hn::Mul(m, hn::Set(tag, input.gravity[0])), hn::Mul(m, hn::Set(tag, input.gravity[1])),
          hn::Mul(m, hn::Set(tag, input.gravity[2]))};
}

HWY_INLINE void store(const Vector& f, const Forces& forces, std::size_t at) {
  hn::StoreU(f.x, tag, forces.component[0] + at);
  hn::StoreU(f.y, tag, forces.component[1] + at);
  hn::StoreU(f.z, tag, forces.component[2] + at);
}

template <Arithmetic arithmetic>
void lattice_forces_in(const Lattice& lattice, const ForceInput& input, std::size_t plane, Range range,
                       const Forces& forces) {
  const auto planes = static_cast<int>(lattice.planes()), own = static_cast<int>(plane);
  const std::span<const Direction> directions = lattice.directions();
  const Particles& at = *input.at;
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t m = range.first + n, p = lattice.first() + plane * lattice.plane_size() + m;
    const std::uint16_t* const neighbours = lattice.neighbours(m);
    const Vector x = load(at.x, p), v = load(at.v, p);
    Vector f = weight_of(input, p);
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const Direction& to = directions[d];
      if (neighbours[d] == 0 || own + to.planes < 0 || own + to.planes >= planes) continue;
      const std::size_t other = p + static_cast<std::size_t>(to.step);
      const Spring of = {hn::Set(tag, to.constants.stiffness), hn::Set(tag, to.constants.damping),
                         hn::Set(tag, to.constants.rest_length), hn::Set(tag, to.constants.slack),
                         hn::Set(tag, to.nothing)};
      const Vector pull = spring<arithmetic>(x - load(at.x, other), v - load(at.v, other), of);
      f = chosen(mask_of(neighbours[d], m % slice), f - pull, f);
    }
    store(f, forces, n);
  }
}

HWY_INLINE Vector gathered(const VectorArray& a, hn::Vec<hn::RebindToSigned<Tag>> i) {
  return {hn::GatherIndex(tag, a[0].data(), i), hn::GatherIndex(tag, a[1].data(), i),
          hn::GatherIndex(tag, a[2].data(), i)};
}

template <Arithmetic arithmetic>
void listed_forces_in(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces) {
  const hn::RebindToSigned<Tag> index_tag;
  const Particles& at = *input.at;
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t local = range.first + n, lane = local % slice, p = lists.first() + local;
    const Vector x = load(at.x, p), v = load(at.v, p);
    Vector f = weight_of(input, p);
    for (const SpringLists::Slot& slot : lists.slots(local / slice)) {
      const auto other = hn::LoadU(index_tag, slot.neighbour.data() + lane);
      const auto kind = hn::LoadU(index_tag, slot.spring_class.data() + lane);
      const Spring of = {hn::GatherIndex(tag, lists.stiffness().data(), kind),
                         hn::GatherIndex(tag, lists.damping().data(), kind),
                         hn::GatherIndex(tag, lists.rest_length().data(), kind),
                         hn::GatherIndex(tag, lists.slack().data(), kind),
                         hn::LoadU(tag, slot.nothing.data() + lane)};
      const Vector pull = spring<arithmetic>(x - gathered(at.x, other), v - gathered(at.v, other), of);
      f = chosen(mask_of(slot.present, lane), f - pull, f);
    }
    store(f, forces, n);
  }
}

void LatticeForces(const Lattice& lattice, const ForceInput& input, std::size_t plane, Range range,
                   const Forces& forces) {
  if (input.arithmetic == Arithmetic::fast)
    return lattice_forces_in<Arithmetic::fast>(lattice, input, plane, range, forces);
  lattice_forces_in<Arithmetic::exact>(lattice, input, plane, range, forces);
}

void ListedForces(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces) {
  if (input.arithmetic == Arithmetic::fast)
    return listed_forces_in<Arithmetic::fast>(lists, input, range, forces);
  listed_forces_in<Arithmetic::exact>(lists, input, range, forces);
}

/// Reads and writes vectors of up to `lanes` particles: neighbouring particles may be another thread's.
struct Part {
  std::size_t count;
  HWY_INLINE Float load(const float* from) const {
    if (count >= lanes) return hn::LoadU(tag, from);
    alignas(64) float some[slice] = {};
    for (std::size_t i = 0; i < count; ++i) some[i] = from[i];
    return hn::Load(tag, some);
  }
  HWY_INLINE void store(Float v, float* to) const {
    if (count >= lanes) return hn::StoreU(v, tag, to);
    alignas(64) float all[slice];
    hn::Store(v, tag, all);
    for (std::size_t i = 0; i < count; ++i) to[i] = all[i];
  }
};

void Move(const StageMove& stage, Range range, const Forces& forces) {
  const Float advance = hn::Set(tag, stage.advance), weight = hn::Set(tag, stage.weight),
              scale = hn::Set(tag, stage.step_scale), half = hn::Set(tag, 0.5f);
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t p = range.first + n;
    const Part part{range.count - n};
    const Float w = part.load(stage.inverse_mass + p);
    for (std::size_t c = 0; c < 3; ++c) {
      const Float a = hn::Mul(w, hn::LoadU(tag, forces.component[c] + n));
      const Float at_v = part.load(stage.at->v[c].data() + p);
      const Float start_x = part.load(stage.start->x[c].data() + p),
                  start_v = part.load(stage.start->v[c].data() + p);
      Float slope_x = hn::Mul(weight, at_v), slope_v = hn::Mul(weight, a);
      if (stage.accumulate) {
        slope_x = hn::Add(part.load(stage.sums->x[c].data() + p), slope_x);
        slope_v = hn::Add(part.load(stage.sums->v[c].data() + p), slope_v);
      }
      Float next_x, next_v;
      if (stage.last) {
        next_v = hn::Add(start_v, hn::Mul(scale, slope_v));
        next_x = hn::Add(start_x, hn::Mul(scale, stage.drift == Drift::new_velocity ? next_v : slope_x));
      } else {
        if (stage.weight != 0.0f) {
          part.store(slope_x, stage.sums->x[c].data() + p);
          part.store(slope_v, stage.sums->v[c].data() + p);
        }
        next_v = hn::Add(start_v, hn::Mul(advance, a));
        const Float moves = stage.drift == Drift::mean_velocity ? hn::Mul(half, hn::Add(at_v, next_v)) : at_v;
        next_x = hn::Add(start_x, hn::Mul(advance, moves));
      }
      part.store(next_x, stage.next->x[c].data() + p);
      part.store(next_v, stage.next->v[c].data() + p);
    }
  }
}

Box BoxOf(const VectorArray& x, Range range) {
  Box box;
  for (std::size_t c = 0; c < 3; ++c) {
    const float* const from = x[c].data() + range.first;
    float least = from[0], most = from[0];
    std::size_t n = 0;
    if (range.count >= lanes) {
      Float low = hn::LoadU(tag, from), high = low;
      for (n = lanes; n + lanes <= range.count; n += lanes) {
        const Float at = hn::LoadU(tag, from + n);
        low = hn::Min(low, at);
        high = hn::Max(high, at);
      }
      least = hn::GetLane(hn::MinOfLanes(tag, low));
      most = hn::GetLane(hn::MaxOfLanes(tag, high));
    }
    for (; n < range.count; ++n) {
      least = from[n] < least ? from[n] : least;
      most = from[n] > most ? from[n] : most;
    }
    box.min[c] = least;
    box.max[c] = most;
  }
  return box;
}

bool AllSound(const Particles& particles, Range range, float limit) {
  const Float most = hn::Set(tag, limit), largest = hn::Set(tag, hwy::HighestValue<float>());
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const Part part{range.count - n};
    const auto at = [&](const VectorArray& a) {
      return Vector{part.load(a[0].data() + range.first + n), part.load(a[1].data() + range.first + n),
                    part.load(a[2].data() + range.first + n)};
    };
    const Vector x = at(particles.x), v = at(particles.v);
    const Mask finite = hn::And(hn::Le(hn::Abs(x.x), largest),
                                hn::And(hn::Le(hn::Abs(x.y), largest), hn::Le(hn::Abs(x.z), largest)));
    if (!hn::AllTrue(tag, hn::And(finite, hn::Le(dot3(v, v), most)))) return false;
  }
  return true;
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(LatticeForces);
HWY_EXPORT(ListedForces);
HWY_EXPORT(Move);
HWY_EXPORT(BoxOf);
HWY_EXPORT(AllSound);

void lattice_forces(const Lattice& lattice, const ForceInput& input, std::size_t plane, Range range,
                    const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(LatticeForces)(lattice, input, plane, range, forces);
}
void listed_forces(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(ListedForces)(lists, input, range, forces);
}
void move(const StageMove& stage, Range range, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(Move)(stage, range, forces);
}
Box box_of(const VectorArray& x, Range range) {
  return HWY_DYNAMIC_DISPATCH(BoxOf)(x, range);
}
bool all_sound(const Particles& particles, Range range, float limit) {
  return HWY_DYNAMIC_DISPATCH(AllSound)(particles, range, limit);
}
std::string_view instruction_set() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace aspic::parallel
#endif
