#pragma once
// For software rasterizers only: how finely they draw, while something moves.
#include <array>
#include <cstddef>
#include <optional>

namespace aspic {

/// Chooses the share of the full resolution, in each direction, from what images took: a time that does not
/// depend on the pixels and one that grows with them. The two finest shares tried
/// so far predict the others; one alone is taken as if all its time grew with the pixels. One slow image
/// does not count, and a share that was too fine is not tried again at once: a resolution that swings is
/// seen.
class Resolution {
 public:
  /// The time that an image may take [s].
  static constexpr double in_motion = 0.045;
  /// While steps are late: the solver needs the processors.
  static constexpr double hurried = 0.015;
  /// Few shares, so that images do not swim; each has about half the pixels of the one before.
  static constexpr std::array shares = {1.0, 0.75, 0.55, 0.4, 0.3};
  static constexpr double coarsest = shares.back();

  /// The share for the next image, one of `shares`.
  double share() const { return shares[chosen_]; }
  /// An image at this share, one of `shares`, took so long [s], > 0. The first after a change of what is
  /// drawn does not count. The next may take `time` [s].
  void took(double share, double seconds, double time = in_motion);
  /// Other things are drawn: begins coarsely again, where images may take long.
  void reset(bool large);

 private:
  double guess(std::size_t i) const;
  std::size_t choose(double time, std::size_t now) const;
  std::array<std::optional<double>, shares.size()> times_;  // of images at each share [s]
  std::array<int, shares.size()> ages_ = {};                // images since
  std::size_t chosen_ = 0;                                  // index of a share
  int slow_ = 0, patience_ = 0;  // images that were too slow, and before a finer share
};

}  // namespace aspic
