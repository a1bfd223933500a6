#pragma once
// Which steps of an interactive run belong in a video.
#include <cstdint>
#include <optional>

#include "io/frame_schedule.h"

namespace aspic {

/// Images of a video come speed/fps seconds of simulated time after one another, each at the nearest step,
/// counted from where the video began: nothing adds up. Steps, speed and time step may change under way.
class VideoPace {
 public:
  /// Images per second shown, > 0.
  explicit VideoPace(double fps) : fps_(fps) {}

  /// How many images of the state at `step` the video still wants; those count as taken. Several where one
  /// step is shown for longer than one image. Counting starts again, with an image at once, at the first
  /// call and wherever the run did not get to by itself: back in time, at another start, or beyond
  /// next_step(). Another speed or time step [s] counts from the last image on. All > 0.
  std::uint64_t take(std::uint64_t step, double timestep, double speed);
  /// The step of the next image, which the run must not pass before take().
  std::uint64_t next_step() const;
  /// The speed last given to take(); 0 before.
  double speed() const { return speed_; }
  /// The next take() counts from where it is.
  void restart() { schedule_.reset(); }

 private:
  void count_from(std::uint64_t step);
  double fps_, timestep_ = 0.0, speed_ = 0.0;
  std::optional<FrameSchedule> schedule_;
  std::uint64_t frame_ = 0, last_taken_ = 0, last_seen_ = 0;
};

}  // namespace aspic
