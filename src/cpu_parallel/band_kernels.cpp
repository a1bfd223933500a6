#include "cpu_parallel/band_kernels.h"

#include <algorithm>

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/band_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// What is added to an upper end where there is no spring, or one of no length: it changes no sum.
HWY_INLINE Float no_force() {
  return hn::Set(tag, -0.0f);
}

/// Where a sweep stands, for one slice of particles.
struct SliceAt {
  std::size_t particle;  ///< the slice's first
  std::size_t sum;       ///< its place in the sums
};

/// What bands are read from. Pointers are copies, since every store could change those in memory.
struct Tables {
  const float *stiffness, *damping, *rest_length;
  const Bands::Lanes* lanes;
  std::size_t classes;
  explicit Tables(const Bands& bands)
      : stiffness(bands.stiffness().data()),
        damping(bands.damping().data()),
        rest_length(bands.rest_length().data()),
        lanes(bands.lanes()),
        classes(bands.classes()) {}
};

/// Positions and velocities of particles.
struct Chunk {
  const float *x[3], *v[3];
  explicit Chunk(const Particles& at) {
    for (std::size_t c = 0; c < 3; ++c) {
      x[c] = at.x[c].data();
      v[c] = at.v[c].data();
    }
  }
};

HWY_INLINE Vector load_of(const float* const (&from)[3], std::size_t i) {
  return {hn::LoadU(tag, from[0] + i), hn::LoadU(tag, from[1] + i), hn::LoadU(tag, from[2] + i)};
}

HWY_INLINE Spring spring_of(const Tables& all, const Band& band, std::size_t lane) {
  if (band.kind < all.classes)
    return {hn::Set(tag, all.stiffness[band.kind]), hn::Set(tag, all.damping[band.kind]),
            hn::Set(tag, all.rest_length[band.kind])};
  const Bands::Lanes& lanes_of = all.lanes[band.kind - all.classes];
  return {hn::LoadU(tag, lanes_of.stiffness.data() + lane), hn::LoadU(tag, lanes_of.damping.data() + lane),
          hn::LoadU(tag, lanes_of.rest_length.data() + lane)};
}

/// Evaluates `size` bands of some lanes of a slice, from the farthest neighbors on: bands[size − 1] first.
template <std::size_t size>
HWY_INLINE void evaluate(const Tables& all, const Chunk& at, const Band* bands, const SliceAt& own,
                         std::size_t lane, const Forces& sums, const Forces& pulls, std::size_t number) {
  const std::size_t p = own.particle + lane;
  const Vector x = load_of(at.x, p), v = load_of(at.v, p);
  Vector e[size], dv[size];
  Spring of[size];
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t other = p + static_cast<std::size_t>(bands[i].step);
    e[i] = x - load_of(at.x, other);
    dv[i] = v - load_of(at.v, other);
    of[i] = spring_of(all, bands[i], lane);
  }
  Float factor[size], length[size];
  evaluate_springs(e, dv, of, factor, length);
  const Float none = no_force();
  for (std::size_t i = size; i-- > 0;) {
    const Mask present = mask_of(bands[i].present, lane);
    const Mask pulling = hn::And(present, hn::Gt(length[i], hn::Zero(tag)));
    const Vector force = chosen(pulling, factor[i] * e[i], {none, none, none});
    store(force, pulls, (number + i) * slice + lane);
    const std::size_t upper = own.sum + lane + static_cast<std::size_t>(bands[i].step);
    store(load(sums, upper) + force, sums, upper);
  }
}

/// All bands from `least` on of a slice, a vector of its particles after the other and of each the farthest
/// neighbors first: so a particle takes its lower neighbors in ascending order.
HWY_INLINE void evaluate_slice(const Tables& all, const Chunk& at, std::span<const Band> bands,
                               std::size_t least, const SliceAt& own, const Forces& sums,
                               const Forces& pulls) {
  constexpr std::size_t together = 4;
  for (std::size_t lane = 0; lane < slice; lane += lanes) {
    std::size_t end = bands.size();
    for (; end >= least + together; end -= together)
      evaluate<together>(all, at, bands.data() + end - together, own, lane, sums, pulls, end - together);
    for (; end > least; --end) evaluate<1>(all, at, bands.data() + end - 1, own, lane, sums, pulls, end - 1);
  }
}

void BandForces(const Bands& all, const ForceInput& input, BandSweep& sweep, std::size_t count,
                const Forces& forces) {
  const Forces sums = sweep.sums(), pulls = sweep.pulls();
  const Tables tables(all);
  const Chunk at(*input.at);
  for (std::size_t n = 0; n < count; n += slice) {
    const std::span<const Band> bands = all.bands((sweep.at() + n) / slice);
    evaluate_slice(tables, at, bands, 0, {all.first() + sweep.at() + n, n}, sums, pulls);
    for (std::size_t lane = 0; lane < slice; lane += lanes) {
      Vector f = load(sums, n + lane);
      for (std::size_t b = 0; b < bands.size(); ++b) {
        const Vector less = f - load(pulls, b * slice + lane);
        // Absent springs pull −0 here, which is not +0.
        f = chosen(mask_of(bands[b].present, lane), less, f);
      }
      store(f, forces, n + lane);
    }
  }
}

void BandGhosts(const Bands& all, const ForceInput& input, BandSweep& sweep, std::size_t count,
                std::size_t target) {
  const Tables tables(all);
  const Chunk at(*input.at);
  for (std::size_t n = 0; n < count; n += slice) {
    const std::size_t local = sweep.at() + n;
    const std::span<const Band> bands = all.bands(local / slice);
    std::size_t least = 0;
    while (least < bands.size() && local + slice + static_cast<std::size_t>(bands[least].step) <= target)
      ++least;
    evaluate_slice(tables, at, bands, least, {all.first() + local, n}, sweep.sums(), sweep.pulls());
  }
}

/// The weight of `count` particles from `first` of the body on, as far as it goes, into the sums at `to`.
void BandWeights(const Bands& bands, const ForceInput& input, std::size_t first, std::size_t count,
                 const Forces& sums, std::size_t to) {
  for (std::size_t n = 0; n < count && first + n < bands.count(); n += lanes)
    store(body_force(input, bands.first() + first + n), sums, to + n);
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(BandForces);
HWY_EXPORT(BandGhosts);
HWY_EXPORT(BandWeights);

void BandSweep::begin(const Bands& bands, const ForceInput& input, std::size_t at) {
  at_ = at;
  HWY_DYNAMIC_DISPATCH(BandWeights)(bands, input, at, size_, sums(), 0);
}

void BandSweep::advance(const Bands& bands, const ForceInput& input, std::size_t count) {
  for (FloatArray& of : sums_) std::copy(of.data() + count, of.data() + size_, of.data());
  at_ += count;
  HWY_DYNAMIC_DISPATCH(BandWeights)
  (bands, input, at_ + size_ - count, count, sums(), size_ - count);
}

void band_forces(const Bands& bands, const ForceInput& input, BandSweep& sweep, std::size_t count,
                 const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(BandForces)(bands, input, sweep, count, forces);
}
void band_ghosts(const Bands& bands, const ForceInput& input, BandSweep& sweep, std::size_t count,
                 std::size_t target) {
  HWY_DYNAMIC_DISPATCH(BandGhosts)(bands, input, sweep, count, target);
}

}  // namespace aspic::parallel
#endif
