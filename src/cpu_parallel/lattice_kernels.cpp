#include "cpu_parallel/lattice_kernels.h"

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/lattice_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// Directions to upper neighbours.
constexpr std::size_t most_upper = 16;

/// What springs take off the forces on their lower ends, by direction and component.
struct Pulls {
  alignas(64) float of[most_upper][3][chunk_size];
  HWY_INLINE Forces at(std::size_t direction) {
    return {{of[direction][0], of[direction][1], of[direction][2]}};
  }
};

/// The springs of a chunk in one direction: what they pull is kept and added to their upper ends.
template <Arithmetic arithmetic>
HWY_INLINE void evaluate(const Lattice& lattice, const Particles& at, std::size_t plane, const Range& range,
                         std::size_t d, const Forces& upper_ends, const Forces& pulls) {
  const Direction& to = lattice.directions()[d];
  const Spring of = {hn::Set(tag, to.constants.stiffness), hn::Set(tag, to.constants.damping),
                     hn::Set(tag, to.constants.rest_length)};
  const std::size_t plane_first = lattice.first() + plane * lattice.plane_size();
  const std::ptrdiff_t in_plane = to.step - to.planes * static_cast<std::ptrdiff_t>(lattice.plane_size());
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t m = range.first + n, p = plane_first + m;
    const std::size_t other = p + static_cast<std::size_t>(to.step);
    const Vector e = load(at.x, p) - load(at.x, other);
    const Pull found = pull<arithmetic>(e, load(at.v, p) - load(at.v, other), of);
    const Mask present = mask_of(lattice.neighbours(m)[d], m % slice);
    Vector force;
    if constexpr (arithmetic == Arithmetic::fast) {
      force = hn::IfThenElseZero(present, found.factor) * e;
    } else {
      // −0 changes no sum. A spring of no length takes +0 off its upper end, which is the same as adding −0.
      const Float none = hn::Set(tag, -0.0f);
      const Mask pulling = hn::And(present, hn::Gt(found.length, hn::Zero(tag)));
      force = chosen(pulling, found.factor * e, {none, none, none});
    }
    store(force, pulls, n);
    const std::size_t end = m + static_cast<std::size_t>(in_plane);
    store(load(upper_ends, end) + force, upper_ends, end);
  }
}

template <Arithmetic arithmetic>
void springs_in(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                const Range& range, int reach, const Forces* forces) {
  const std::span<const Direction> directions = lattice.directions();
  const std::size_t half = directions.size() / 2;
  const std::size_t left = lattice.planes() - 1 - plane;
  Pulls pulls;
  std::size_t end = directions.size();
  while (static_cast<std::size_t>(directions[end - 1].planes) > left) --end;
  // The farthest direction first: an upper end takes its lower neighbours in ascending order.
  for (std::size_t d = end; d-- > half && directions[d].planes >= reach;)
    evaluate<arithmetic>(lattice, *input.at, plane, range, d,
                         sweep.plane(plane + static_cast<std::size_t>(directions[d].planes)),
                         pulls.at(d - half));
  if (!forces) return;
  const Forces so_far = sweep.plane(plane);
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t m = range.first + n;
    const std::uint16_t* const neighbours = lattice.neighbours(m);
    Vector f = load(so_far, m);
    for (std::size_t d = half; d < end; ++d) {
      const Vector less = f - load(pulls.at(d - half), n);
      // In exact arithmetic absent springs pull −0 here, which is not +0.
      f = arithmetic == Arithmetic::fast ? less : chosen(mask_of(neighbours[d], m % slice), less, f);
    }
    store(f, *forces, n);
  }
}

void LatticeSprings(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    const Range& range, int reach, const Forces* forces) {
  if (input.arithmetic == Arithmetic::fast)
    return springs_in<Arithmetic::fast>(lattice, input, sweep, plane, range, reach, forces);
  springs_in<Arithmetic::exact>(lattice, input, sweep, plane, range, reach, forces);
}

void BeginPlane(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane) {
  const std::size_t first = lattice.first() + plane * lattice.plane_size();
  for (std::size_t m = 0; m < lattice.plane_size(); m += lanes)
    store(weight_of(input, first + m), sweep.plane(plane), m);
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(LatticeSprings);
HWY_EXPORT(BeginPlane);

void begin_plane(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t n) {
  HWY_DYNAMIC_DISPATCH(BeginPlane)(lattice, input, sweep, n);
}
void lattice_ghosts(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    int reach) {
  for (std::size_t m = 0; m < lattice.plane_size(); m += chunk_size) HWY_DYNAMIC_DISPATCH(LatticeSprings)
  (lattice, input, sweep, plane, {m, std::min(chunk_size, lattice.plane_size() - m)}, reach, nullptr);
}
void lattice_forces(const Lattice& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    Range range, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(LatticeSprings)(lattice, input, sweep, plane, range, 0, &forces);
}

}  // namespace aspic::parallel
#endif
