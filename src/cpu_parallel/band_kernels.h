#pragma once
// Forces of springs in bands, each evaluated once. A sweep goes through the slices in ascending order; what a
// spring adds to its upper end waits in sums of the particles that the sweep has reached, so that every
// particle adds in ascending neighbor index, as in lattice_kernels.h.
#include <cstddef>
#include <vector>

#include "cpu_parallel/bands.h"
#include "cpu_parallel/kernels.h"

namespace aspic::parallel {

/// Particles of a sweep that are moved together.
inline constexpr std::size_t band_piece = 512;

/// Forces that particles have got so far [N], of a piece and as far as its springs reach.
class BandSweep {
 public:
  BandSweep() = default;
  BandSweep(std::size_t reach, std::size_t most_bands)
      : size_((band_piece + reach) / slice * slice + 2 * slice),
        sums_(vector_array(size_ + slice, slice)),
        pulls_(vector_array(most_bands * slice, slice)) {}

  /// Begins at a particle of the body, a multiple of `slice`: all have their weight.
  void begin(const Bands& bands, const ForceInput& input, std::size_t at);
  /// Goes on by `count` particles, at most band_piece, a multiple of `slice`.
  void advance(const Bands& bands, const ForceInput& input, std::size_t count);
  std::size_t at() const { return at_; }
  Forces sums() { return {{sums_[0].data(), sums_[1].data(), sums_[2].data()}}; }
  Forces pulls() { return {{pulls_[0].data(), pulls_[1].data(), pulls_[2].data()}}; }
  std::uint64_t bytes() const { return bytes_of(sums_) + bytes_of(pulls_); }

 private:
  std::size_t at_ = 0, size_ = 0;
  VectorArray sums_, pulls_;
};

/// The springs of `count` particles from where the sweep is on, at most band_piece, to their upper
/// neighbors. Writes their forces, and up to `slice` − 1 values more.
void band_forces(const Bands& bands, const ForceInput& input, BandSweep& sweep, std::size_t count,
                 const Forces& forces);
/// Of these springs those that a sweep which begins at `target` needs.
void band_ghosts(const Bands& bands, const ForceInput& input, BandSweep& sweep, std::size_t count,
                 std::size_t target);

}  // namespace aspic::parallel
