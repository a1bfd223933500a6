// Springs in the linear system of implicit Euler: forces and diagonal blocks at a trial velocity, and the
// product of the matrix with a direction.
#include "cpu_parallel/implicit_kernels.h"
#include "cpu_parallel/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/implicit_springs.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// Constants of a spring in every lane.
struct SpringLanes {
  Spring of;
  Float slack, nothing, along;
};

HWY_INLINE SpringLanes constants_of(const Direction& to, float along) {
  return {{hn::Set(tag, to.constants.stiffness), hn::Set(tag, to.constants.damping),
           hn::Set(tag, to.constants.rest_length)},
          hn::Set(tag, to.constants.slack),
          hn::Set(tag, to.nothing),
          hn::Set(tag, along)};
}

/// What a spring takes off the force on its particle, and its Jacobian but for `along`.
struct LinearizedSpring {
  Vector force, n;
  Float across;
};

HWY_INLINE LinearizedSpring linearized(const SpringLanes& spring, const Vector& e, const Vector& v,
                                       Float h2) {
  const Float zero = hn::Zero(tag);
  Float L[1], q[1], s[1];
  evaluate_tensions({e}, {v}, {spring.of}, L, q, s);
  const Float sq = hn::Mul(s[0], q[0]);
  const Mask idle = hn::Or(hn::Eq(L[0], zero), hn::Lt(L[0], spring.slack));
  const Float across = hn::IfThenElseZero(hn::AndNot(idle, hn::Gt(s[0], zero)), hn::Mul(h2, sq));
  return {chosen(idle, {spring.nothing, spring.nothing, spring.nothing}, sq * e),
          chosen(idle, {zero, zero, zero}, q[0] * e), across};
}

HWY_INLINE Float implicit_mass(const Linearization& at, std::size_t p) {
  return BodyForce(*at.body_force)
      .implicit_mass(hn::LoadU(tag, at.mass + p), load(*at.v, p), hn::Set(tag, at.h));
}

/// Force and diagonal block of the particles in the lanes.
struct Sums {
  Vector f, diagonal, mixed;

  HWY_INLINE Sums(const Linearization& at, std::size_t p) {
    f = BodyForce(*at.body_force).at(hn::LoadU(tag, at.mass + p), load(*at.v, p));
    const Float mass = implicit_mass(at, p), zero = hn::Zero(tag);
    diagonal = {mass, mass, mass};
    mixed = {zero, zero, zero};
  }
  HWY_INLINE void add(Mask mask, const LinearizedSpring& s, Float along) {
    const Float w = hn::Sub(along, s.across);
    const auto& [x, y, z] = s.n;
    const Vector squares = w * Vector{hn::Mul(x, x), hn::Mul(y, y), hn::Mul(z, z)};
    f = chosen(mask, f - s.force, f);
    diagonal = chosen(mask, diagonal + (Vector{s.across, s.across, s.across} + squares), diagonal);
    mixed = chosen(mask, mixed + w * Vector{hn::Mul(x, y), hn::Mul(x, z), hn::Mul(y, z)}, mixed);
  }
};

/// Lanes of which only some are particles of the segment: the others are another thread's.
struct Lanes {
  std::size_t from, to;  ///< of the segment

  /// `count` particles from `first` on, of which the lanes begin with number `at`.
  HWY_INLINE Lanes(const Range& own, std::size_t at)
      : from(at < own.first ? own.first - at : 0), to(std::min(lanes, own.first + own.count - at)) {}

  /// `to_lane_0` is where lane 0 would go.
  HWY_INLINE void store(Float v, float* to_lane_0) const {
    if (from == 0 && to == lanes) return hn::StoreU(v, tag, to_lane_0);
    alignas(64) float all[slice];
    hn::Store(v, tag, all);
    for (std::size_t i = from; i < to; ++i) to_lane_0[i] = all[i];
  }
  HWY_INLINE void store(const Vector& v, float* x, float* y, float* z, std::ptrdiff_t at) const {
    store(v.x, x + at);
    store(v.y, y + at);
    store(v.z, z + at);
  }
  HWY_INLINE void store(const Sums& sums, const LinearizedForces& out, std::ptrdiff_t at) const {
    store(sums.f, out.force[0], out.force[1], out.force[2], at);
    store(sums.diagonal, out.block[0], out.block[1], out.block[2], at);
    store(sums.mixed, out.block[3], out.block[4], out.block[5], at);
  }
  HWY_INLINE void store(const LinearizedSpring& s, float* rows, std::size_t row_size) const {
    store(s.across, rows);
    store(s.n, rows + row_size, rows + 2 * row_size, rows + 3 * row_size, 0);
  }
};

/// Calls take(direction number, mask) for the directions in which some of the lanes have a neighbor.
template <class Take>
HWY_INLINE void for_each_direction(const LatticeStencil& lattice, std::size_t plane, std::size_t m,
                                   const Take& take) {
  const auto planes = static_cast<int>(lattice.planes()), own = static_cast<int>(plane);
  const std::span<const Direction> directions = lattice.directions();
  const std::uint16_t* const neighbors = lattice.neighbors(m);
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const int other = own + directions[d].planes;
    if (neighbors[d] != 0 && other >= 0 && other < planes) take(d, mask_of(neighbors[d], m % slice));
  }
}

void LinearizeLattice(const LatticeStencil& lattice, Jacobians& jacobians, const Linearization& at,
                      const Segment& segment, const LinearizedForces& out) {
  const std::span<const Direction> directions = lattice.directions();
  const Float h = hn::Set(tag, at.h), h2 = hn::Set(tag, at.h * at.h);
  const Range& own = segment.own;
  for (std::size_t m = own.first / lanes * lanes; m < own.first + own.count; m += lanes) {
    const Lanes part(own, m);
    const std::size_t p = lattice.first() + segment.plane * lattice.plane_size() + m;
    const Vector x = load(*at.x, p), v = load(*at.v, p);
    Sums sums(at, p);
    for_each_direction(lattice, segment.plane, m, [&](std::size_t d, Mask mask) {
      const Direction& to = directions[d];
      const std::size_t other = p + static_cast<std::size_t>(to.step);
      const SpringLanes spring = constants_of(to, jacobians.along()[d]);
      const Vector dv = v - load(*at.v, other);
      const LinearizedSpring s = linearized(spring, (x - load(*at.x, other)) + h * dv, dv, h2);
      sums.add(mask, s, spring.along);
      if (to.step > 0 && jacobians.kept())
        part.store(s, jacobians.row(segment.plane, d - directions.size() / 2) + m, jacobians.row_size());
    });
    part.store(sums, out, static_cast<std::ptrdiff_t>(m) - static_cast<std::ptrdiff_t>(own.first));
  }
}

HWY_INLINE Vector times(Float along, Float across, const Vector& n, const Vector& d) {
  return across * d + hn::Mul(hn::Sub(along, across), dot3(n, d)) * n;
}

HWY_INLINE Vector kept_times(const float* rows, std::size_t row_size, Float along, const Vector& d) {
  const Vector n = {hn::LoadU(tag, rows + row_size), hn::LoadU(tag, rows + 2 * row_size),
                    hn::LoadU(tag, rows + 3 * row_size)};
  return times(along, hn::LoadU(tag, rows), n, d);
}

template <bool kept>
HWY_INLINE void multiply_lattice(const LatticeStencil& lattice, const Jacobians& jacobians,
                                 const Linearization& at, const VectorArray& p, const Segment& segment,
                                 const std::array<float*, 3>& out) {
  const std::span<const Direction> directions = lattice.directions();
  const Float h = hn::Set(tag, at.h), h2 = hn::Set(tag, at.h * at.h);
  const Range& own = segment.own;
  for (std::size_t m = own.first / lanes * lanes; m < own.first + own.count; m += lanes) {
    const std::size_t i = lattice.first() + segment.plane * lattice.plane_size() + m;
    const Vector p_i = load(p, i);
    Vector product = implicit_mass(at, i) * p_i;
    for_each_direction(lattice, segment.plane, m, [&](std::size_t d, Mask mask) {
      const Direction& to = directions[d];
      const std::size_t other = i + static_cast<std::size_t>(to.step);
      const Vector difference = p_i - load(p, other);
      const Float along = hn::Set(tag, jacobians.along()[d]);
      Vector part;
      if constexpr (kept) {
        // A spring's Jacobian is kept at its lower end. Directions are in ascending order, so that opposite
        // ones stand opposite each other.
        const bool up = to.step > 0;
        const std::size_t number = up ? d - directions.size() / 2 : directions.size() / 2 - 1 - d;
        const auto plane = static_cast<std::ptrdiff_t>(segment.plane) + (up ? 0 : to.planes);
        const std::ptrdiff_t within =
            up ? 0 : to.step - to.planes * static_cast<std::ptrdiff_t>(lattice.plane_size());
        const float* const rows = jacobians.row(static_cast<std::size_t>(plane), number) +
                                  (static_cast<std::ptrdiff_t>(m) + within);
        part = kept_times(rows, jacobians.row_size(), along, difference);
      } else {
        const Vector dv = load(*at.v, i) - load(*at.v, other);
        const Vector e = (load(*at.x, i) - load(*at.x, other)) + h * dv;
        const LinearizedSpring s = linearized(constants_of(to, jacobians.along()[d]), e, dv, h2);
        part = times(along, s.across, s.n, difference);
      }
      product = chosen(mask, product + part, product);
    });
    Lanes(own, m).store(product, out[0], out[1], out[2],
                        static_cast<std::ptrdiff_t>(m) - static_cast<std::ptrdiff_t>(own.first));
  }
}

void MultiplyLattice(const LatticeStencil& lattice, const Jacobians& jacobians, const Linearization& at,
                     const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out) {
  if (jacobians.kept()) return multiply_lattice<true>(lattice, jacobians, at, p, segment, out);
  multiply_lattice<false>(lattice, jacobians, at, p, segment, out);
}

using Index = hn::Vec<hn::RebindToSigned<Tag>>;

/// One slot of lists in the lanes.
struct SlotLanes {
  Index other, spring_class;
  Mask present;

  HWY_INLINE SlotLanes(const SpringLists::Slot& slot, std::size_t lane)
      : present(mask_of(slot.present, lane)) {
    const hn::RebindToSigned<Tag> index_tag;
    other = hn::LoadU(index_tag, slot.neighbor.data() + lane);
    spring_class = hn::LoadU(index_tag, slot.spring_class.data() + lane);
  }
  HWY_INLINE Float along(const Jacobians& jacobians) const {
    return hn::GatherIndex(tag, jacobians.along(), spring_class);
  }
};

HWY_INLINE LinearizedSpring linearized(const SpringLists& lists, const SpringLists::Slot& slot,
                                       std::size_t lane, const Linearization& at, std::size_t p) {
  const SlotLanes lane_of(slot, lane);
  const Float h = hn::Set(tag, at.h), h2 = hn::Set(tag, at.h * at.h);
  const SpringLanes spring = {{hn::GatherIndex(tag, lists.stiffness().data(), lane_of.spring_class),
                               hn::GatherIndex(tag, lists.damping().data(), lane_of.spring_class),
                               hn::GatherIndex(tag, lists.rest_length().data(), lane_of.spring_class)},
                              hn::GatherIndex(tag, lists.slack().data(), lane_of.spring_class),
                              hn::LoadU(tag, slot.nothing.data() + lane),
                              hn::Zero(tag)};
  const Vector dv = load(*at.v, p) - gathered(*at.v, lane_of.other);
  return linearized(spring, (load(*at.x, p) - gathered(*at.x, lane_of.other)) + h * dv, dv, h2);
}

/// Number of a slice's first slot among all slots.
HWY_INLINE std::size_t first_slot(const SpringLists& lists, std::size_t slice_index) {
  return static_cast<std::size_t>(lists.slots(slice_index).data() - lists.slots(0).data());
}

void LinearizeLists(const SpringLists& lists, Jacobians& jacobians, const Linearization& at,
                    const Segment& segment, const LinearizedForces& out) {
  const Range& own = segment.own;
  for (std::size_t local = own.first / lanes * lanes; local < own.first + own.count; local += lanes) {
    const Lanes part(own, local);
    const std::size_t p = lists.first() + local, lane = local % slice;
    std::size_t number = first_slot(lists, local / slice);
    Sums sums(at, p);
    for (const SpringLists::Slot& slot : lists.slots(local / slice)) {
      const SlotLanes lane_of(slot, lane);
      const LinearizedSpring s = linearized(lists, slot, lane, at, p);
      sums.add(lane_of.present, s, lane_of.along(jacobians));
      if (jacobians.kept()) part.store(s, jacobians.slot(number) + lane, slice);
      ++number;
    }
    part.store(sums, out, static_cast<std::ptrdiff_t>(local) - static_cast<std::ptrdiff_t>(own.first));
  }
}

void MultiplyLists(const SpringLists& lists, const Jacobians& jacobians, const Linearization& at,
                   const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out) {
  const Range& own = segment.own;
  for (std::size_t local = own.first / lanes * lanes; local < own.first + own.count; local += lanes) {
    const std::size_t i = lists.first() + local, lane = local % slice;
    std::size_t number = first_slot(lists, local / slice);
    const Vector p_i = load(p, i);
    Vector product = implicit_mass(at, i) * p_i;
    for (const SpringLists::Slot& slot : lists.slots(local / slice)) {
      const SlotLanes lane_of(slot, lane);
      const Vector difference = p_i - gathered(p, lane_of.other);
      const Float along = lane_of.along(jacobians);
      Vector part;
      if (jacobians.kept()) {
        part = kept_times(jacobians.slot(number) + lane, slice, along, difference);
      } else {
        const LinearizedSpring s = linearized(lists, slot, lane, at, i);
        part = times(along, s.across, s.n, difference);
      }
      product = chosen(lane_of.present, product + part, product);
      ++number;
    }
    Lanes(own, local)
        .store(product, out[0], out[1], out[2],
               static_cast<std::ptrdiff_t>(local) - static_cast<std::ptrdiff_t>(own.first));
  }
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(LinearizeLattice);
HWY_EXPORT(LinearizeLists);
HWY_EXPORT(MultiplyLattice);
HWY_EXPORT(MultiplyLists);

void Jacobians::set_constants(const LatticeStencil& lattice, float h) {
  along_.clear();
  for (const Direction& to : lattice.directions())
    along_.push_back((h * h) * to.constants.stiffness + h * to.constants.damping);
}

void Jacobians::set_constants(const SpringLists& lists, float h) {
  along_.clear();
  for (std::size_t n = 0; n < lists.stiffness().size(); ++n)
    along_.push_back((h * h) * lists.stiffness()[n] + h * lists.damping()[n]);
}

Jacobians::Jacobians(const LatticeStencil& lattice, float h, bool keep)
    : kept_(keep), ups_(lattice.directions().size() / 2), row_size_(lattice.plane_size()) {
  set_constants(lattice, h);
  // Lanes next to a row's ends are read and not used.
  if (keep) values_ = FloatArray(lattice.planes() * ups_ * 4 * row_size_, 2 * lattice.row_size() + 2 + slice);
}

Jacobians::Jacobians(const SpringLists& lists, float h, bool keep) : kept_(keep) {
  set_constants(lists, h);
  const std::size_t slices = (lists.count() + slice - 1) / slice;
  std::size_t slots = 0;
  for (std::size_t n = 0; n < slices; ++n) slots += lists.slots(n).size();
  if (keep) values_ = FloatArray(slots * 4 * slice, 0);
}

void linearize(const LatticeStencil& lattice, Jacobians& jacobians, const Linearization& at,
               const Segment& segment, const LinearizedForces& out) {
  HWY_DYNAMIC_DISPATCH(LinearizeLattice)(lattice, jacobians, at, segment, out);
}
void linearize(const SpringLists& lists, Jacobians& jacobians, const Linearization& at,
               const Segment& segment, const LinearizedForces& out) {
  HWY_DYNAMIC_DISPATCH(LinearizeLists)(lists, jacobians, at, segment, out);
}
void multiply(const LatticeStencil& lattice, const Jacobians& jacobians, const Linearization& at,
              const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out) {
  HWY_DYNAMIC_DISPATCH(MultiplyLattice)(lattice, jacobians, at, p, segment, out);
}
void multiply(const SpringLists& lists, const Jacobians& jacobians, const Linearization& at,
              const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out) {
  HWY_DYNAMIC_DISPATCH(MultiplyLists)(lists, jacobians, at, p, segment, out);
}

}  // namespace aspic::parallel
#endif
