#pragma once
// Which state each image of a run shows.
#include <cstdint>

namespace aspic {

/// Image f shows the state nearest to f·speed/fps seconds after the run's first state; the last image
/// shows the run's last state, so that it may come less than an image's time after the one before.
class FrameSchedule {
 public:
  /// h: time step [s], > 0. `first_step` ≤ `last_step`. fps: images per second shown, > 0; speed: simulated
  /// seconds per second shown, > 0.
  FrameSchedule(double timestep, std::uint64_t first_step, std::uint64_t last_step, double fps, double speed);

  /// The same for a run whose end nobody knows: every image shows its nearest step.
  static FrameSchedule open_ended(double timestep, std::uint64_t first_step, double fps, double speed);

  /// Images in all, ≥ 1; the largest number there is if the end is open.
  std::uint64_t count() const { return count_; }
  /// The step that image `frame` < count() shows; never decreases.
  std::uint64_t step_of(std::uint64_t frame) const;

 private:
  std::uint64_t first_, last_, count_;
  double steps_per_frame_;  // within what steps and images can count, whatever the quotient overflows to
};

}  // namespace aspic
