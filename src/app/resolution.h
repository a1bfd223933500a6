#pragma once
// How finely a software rasteriser draws: as finely as leaves time for events.
#include <optional>

namespace aspic::app {

/// Chooses the share of the full resolution, in each direction, from what pictures took. A finer picture is
/// taken to take longer by the ratio of the pixels, whatever part of its time does not depend on them: no
/// guess of a finer one is too short, and each finer picture makes the next guess better.
class Resolution {
 public:
  /// Times that a picture may take in motion, and once all stands still [s].
  static constexpr double in_motion = 0.045, at_rest = 0.085;
  static constexpr double coarsest = 0.3;

  /// The share for the next picture, coarsest … 1.
  double share(bool still) const { return still ? still_ : moving_; }
  /// Share in motion.
  double moving() const { return moving_; }
  /// A picture at this share took so long [s], > 0. The first after a change of what is drawn is not told.
  void took(double share, double seconds);
  /// Other things are drawn: begins coarsely again. `large` where pictures may take long.
  void reset(bool large);

 private:
  double choose(double time, double now) const;
  std::optional<double> cost_;  // of a picture in full, at most [s]
  double last_ = 0.0;           // share it was estimated from
  double moving_ = 1.0, still_ = 1.0;
};

}  // namespace aspic::app
