#pragma once
// For software rasterisers only: how finely they draw, so that there is time for events.
#include <array>
#include <cstddef>
#include <optional>

namespace aspic::app {

/// Chooses the share of the full resolution, in each direction, from what pictures took: a time that does not
/// depend on the pixels and one that grows with them. The two finest shares tried
/// so far predict the others; one alone is taken as if all its time grew with the pixels.
class Resolution {
 public:
  /// Times that a picture may take in motion, and at rest [s].
  static constexpr double in_motion = 0.045, at_rest = 0.085;
  /// In motion while steps are late: the solver needs the processors.
  static constexpr double hurried = 0.015;
  /// Few shares, so that pictures do not swim; each has about half the pixels of the one before.
  static constexpr std::array shares = {1.0, 0.75, 0.55, 0.4, 0.3};
  static constexpr double coarsest = shares.back();

  /// The share for the next picture, one of `shares`.
  double share(bool still) const { return shares[still ? still_ : moving_]; }
  /// A picture at this share, one of `shares`, took so long [s], > 0. The first after a change of what is
  /// drawn does not count. In motion the next may take `moving` [s].
  void took(double share, double seconds, double moving = in_motion);
  /// Other things are drawn: begins coarsely again, where pictures may take long.
  void reset(bool large);

 private:
  double guess(std::size_t i) const;
  std::size_t choose(double time, std::size_t now) const;
  std::array<std::optional<double>, shares.size()> times_;  // of pictures at each share [s]
  std::array<int, shares.size()> ages_ = {};                // pictures since
  std::size_t moving_ = 0, still_ = 0;                      // indices of shares
};

}  // namespace aspic::app
