#pragma once
// Springs of a box, each evaluated once. A sweep goes through the planes in ascending order and through a
// plane in ascending chunks. What a spring adds to its upper end waits in sums of the planes that the sweep
// has reached, so that every particle adds in ascending neighbor index: by the time its own chunk comes, all
// its lower neighbors have added theirs.
#include <array>
#include <cstddef>

#include "cpu_parallel/kernels.h"

namespace aspic::parallel {

/// Particles whose springs are evaluated together: their forces stay in the first-level cache until their
/// ends take them.
inline constexpr std::size_t chunk_size = 128;

/// Forces that particles of three planes have got so far [N]: those of the plane at hand and the next two.
class Sweep {
 public:
  Sweep() = default;
  /// For planes and rows of up to so many particles.
  Sweep(std::size_t plane_size, std::size_t row_size) {
    for (VectorArray& plane : planes_) plane = vector_array(plane_size + slice, 2 * row_size + slice);
  }
  Forces plane(std::size_t n) {
    VectorArray& of = planes_[n % planes_.size()];
    return {{of[0].data(), of[1].data(), of[2].data()}};
  }
  std::uint64_t bytes() const { return bytes_of(planes_); }

 private:
  std::array<VectorArray, 3> planes_;
};

/// Plane n enters the sweep: its particles have their weight.
void begin_plane(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t n);

/// Springs from a plane into planes above, `reach` planes on or farther, that a sweep which starts above it
/// needs of it.
void lattice_ghosts(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    int reach);

/// The springs of the particles first … first + count − 1 of a plane to their upper neighbors; `first` is a
/// multiple of `slice`, and count ≤ chunk_size. Writes their forces, and up to `slice` − 1 values more.
void lattice_forces(const LatticeStencil& lattice, const ForceInput& input, Sweep& sweep, std::size_t plane,
                    Range range, const Forces& forces);

}  // namespace aspic::parallel
