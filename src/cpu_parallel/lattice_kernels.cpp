#include "cpu_parallel/lattice_kernels.h"

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/lattice_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// Directions to upper neighbors.
constexpr std::size_t most_upper = 16;

/// What springs take off the forces on their lower ends, by direction and component, with a slice before and
/// after the chunk.
struct Pulls {
  alignas(64) float of[most_upper][3][slice + chunk_size + slice];
  HWY_INLINE Forces at(std::size_t direction) {
    return {{of[direction][0] + slice, of[direction][1] + slice, of[direction][2] + slice}};
  }
};

/// A chunk of particles, and what is read and written for them. Pointers are copies, since every store could
/// change those in memory.
struct Chunk {
  const float *x[3], *v[3];  ///< of the first particle
  std::size_t count;
  const std::uint16_t* bits;  ///< of the first slice and direction
  std::size_t stride;         ///< to the next slice's
};

HWY_INLINE Vector load(const float* const (&from)[3], std::ptrdiff_t n) {
  return {hn::LoadU(tag, from[0] + n), hn::LoadU(tag, from[1] + n), hn::LoadU(tag, from[2] + n)};
}

/// What is added to an upper end where there is no spring, or one of no length: it changes no sum. A spring
/// of no length takes +0 off its upper end, which is the same as adding −0.
HWY_INLINE Float no_force() {
  return hn::Set(tag, -0.0f);
}

/// What springs pull from the particles at n: `size` directions with consecutive steps, `slices` vectors of
/// particles.
template <std::size_t size, std::size_t slices>
HWY_INLINE void evaluate_at(const Chunk& own, std::size_t n, std::ptrdiff_t step, std::size_t d,
                            const Spring (&of)[size], Pulls& pulls, std::size_t kept) {
  constexpr std::size_t springs = size * slices;
  Vector e[springs], dv[springs];
  for (std::size_t s = 0; s < slices; ++s) {
    const auto at = static_cast<std::ptrdiff_t>(n + s * lanes);
    const Vector x = load(own.x, at), v = load(own.v, at);
    for (std::size_t g = 0; g < size; ++g) {
      e[s * size + g] = x - load(own.x, at + step + static_cast<std::ptrdiff_t>(g));
      dv[s * size + g] = v - load(own.v, at + step + static_cast<std::ptrdiff_t>(g));
    }
  }
  Float factor[springs], length[springs];
  evaluate_springs(e, dv, of, factor, length);
  const Float none = no_force();
  for (std::size_t i = 0; i < springs; ++i) {
    const std::size_t at = n + i / size * lanes;
    const Mask present = mask_of(own.bits[at / slice * own.stride + d + i % size], at % slice);
    const Mask pulling = hn::And(present, hn::Gt(length[i], hn::Zero(tag)));
    const Vector force = chosen(pulling, factor[i] * e[i], {none, none, none});
    store(force, pulls.at(kept + i % size), at);
  }
}

/// What the springs of `size` directions pull, whose steps are consecutive, is kept and added to their upper
/// ends. `d`: the first of the directions; `upper`: the end of the first particle's spring in it.
template <std::size_t size>
HWY_INLINE void evaluate(const Chunk& chunk, std::span<const Direction> directions, std::size_t d,
                         const Forces& upper, Pulls& pulls, std::size_t kept) {
  const Chunk own = chunk;
  const std::ptrdiff_t step = directions[d].step;
  Spring of[size];
  for (std::size_t g = 0; g < size; ++g) {
    const Constants& constants = directions[d + g].constants;
    of[g] = {hn::Set(tag, constants.stiffness), hn::Set(tag, constants.damping),
             hn::Set(tag, constants.rest_length)};
  }
  std::size_t n = 0;
  constexpr std::size_t together = 4 / size;
  for (; n + together * lanes <= own.count; n += together * lanes)
    evaluate_at<size, together>(own, n, step, d, of, pulls, kept);
  for (; n < own.count; n += lanes) evaluate_at<size, 1>(own, n, step, d, of, pulls, kept);
  // Around the chunk no spring pulls. The ends of a vector of particles lie in one vector and some lanes of
  // the next, or of the next two where a vector is a single lane.
  constexpr std::size_t beyond = size == 1 ? 0 : std::max(lanes, size - 1);
  const Float none = no_force();
  for (std::size_t g = 0; g < size; ++g) {
    const Forces of_g = pulls.at(kept + g);
    for (std::size_t m = 0; m < beyond; m += lanes) {
      store({none, none, none}, of_g, n + m);
      for (float* const component : of_g.component) hn::StoreU(none, tag, component - beyond + m);
    }
  }
  const std::size_t ends = n + beyond;
  const Forces to = upper;
  for (std::size_t m = 0; m < ends; m += lanes) {
    Vector f = load(to, m);
    for (std::size_t g = size; g-- > 0;) {
      Forces of_g = pulls.at(kept + g);
      for (float*& component : of_g.component) component -= g;
      f = f + load(of_g, m);
    }
    store(f, to, m);
  }
}

/// The same for as many directions below `d` as have consecutive steps, up to three. Returns the last of
/// them.
HWY_INLINE std::size_t evaluate_below(const Chunk& chunk, std::span<const Direction> directions,
                                      std::size_t d, std::size_t least, Forces plane, Pulls& pulls) {
  std::size_t size = 1;
  while (size < 3 && d - size > least && directions[d - size - 1].planes == directions[d - 1].planes &&
         directions[d - size - 1].step + 1 == directions[d - size].step)
    ++size;
  d -= size;
  for (float*& component : plane.component) component += directions[d].step;
  const std::size_t kept = d - directions.size() / 2;
  if (size == 3) evaluate<3>(chunk, directions, d, plane, pulls, kept);
  if (size == 2) evaluate<2>(chunk, directions, d, plane, pulls, kept);
  if (size == 1) evaluate<1>(chunk, directions, d, plane, pulls, kept);
  return d;
}

void LatticeSprings(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    const Range& range, int reach, const Forces* forces) {
  const std::span<const Direction> directions = lattice.directions();
  const std::size_t half = directions.size() / 2, left = lattice.planes() - 1 - plane;
  std::size_t least = half, end = directions.size();
  while (directions[least].planes < reach) ++least;
  while (static_cast<std::size_t>(directions[end - 1].planes) > left) --end;
  const std::size_t first = lattice.first() + plane * lattice.plane_size() + range.first;
  Chunk chunk{{}, {}, range.count, lattice.neighbors(range.first), directions.size()};
  for (std::size_t c = 0; c < 3; ++c) {
    chunk.x[c] = input.at->x[c].data() + first;
    chunk.v[c] = input.at->v[c].data() + first;
  }
  Pulls pulls;
  // The farthest directions first: an upper end takes its lower neighbors in ascending order.
  for (std::size_t d = end; d > least;) {
    const int planes = directions[d - 1].planes;
    Forces upper = sweep.plane(plane + static_cast<std::size_t>(planes));
    for (float*& component : upper.component)
      component += static_cast<std::ptrdiff_t>(range.first) -
                   planes * static_cast<std::ptrdiff_t>(lattice.plane_size());
    d = evaluate_below(chunk, directions, d, least, upper, pulls);
  }
  if (!forces) return;
  const Forces so_far = sweep.plane(plane), out = *forces;
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::uint16_t* const neighbors = lattice.neighbors(range.first + n);
    Vector f = load(so_far, range.first + n);
    for (std::size_t d = half; d < end; ++d) {
      const Vector less = f - load(pulls.at(d - half), n);
      // Absent springs pull −0 here, which is not +0.
      f = chosen(mask_of(neighbors[d], n % slice), less, f);
    }
    store(f, out, n);
  }
}

void BeginPlane(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane) {
  const std::size_t first = lattice.first() + plane * lattice.plane_size();
  for (std::size_t m = 0; m < lattice.plane_size(); m += lanes)
    store(body_force(input, first + m), sweep.plane(plane), m);
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(LatticeSprings);
HWY_EXPORT(BeginPlane);

void begin_plane(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t n) {
  HWY_DYNAMIC_DISPATCH(BeginPlane)(lattice, input, sweep, n);
}
void lattice_ghosts(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    int reach) {
  for (std::size_t m = 0; m < lattice.plane_size(); m += chunk_size) HWY_DYNAMIC_DISPATCH(LatticeSprings)
  (lattice, input, sweep, plane, {m, std::min(chunk_size, lattice.plane_size() - m)}, reach, nullptr);
}
void lattice_forces(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    Range range, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(LatticeSprings)(lattice, input, sweep, plane, range, 0, &forces);
}

}  // namespace aspic::parallel
#endif
