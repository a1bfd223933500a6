#include "io/frame_schedule.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace aspic {
FrameSchedule::FrameSchedule(double timestep, std::uint64_t first_step, std::uint64_t last_step, double fps,
                             double speed)
    : first_(first_step),
      last_(last_step),
      steps_per_frame_(std::clamp(speed / fps / timestep, 0x1p-53, 0x1p63)) {
  assert(timestep > 0.0 && fps > 0.0 && speed > 0.0 && first_step <= last_step);
  const double frames = static_cast<double>(last_ - first_) / steps_per_frame_;
  // A whole number of images up to rounding is meant to be whole.
  const double nearest = std::round(frames);
  const double whole =
      std::abs(frames - nearest) < 1e-9 * std::max(frames, 1.0) ? nearest : std::ceil(frames);
  count_ = static_cast<std::uint64_t>(std::min(whole, 0x1p53)) + 1;
}

FrameSchedule FrameSchedule::open_ended(double timestep, std::uint64_t first_step, double fps, double speed) {
  FrameSchedule schedule(timestep, first_step, std::numeric_limits<std::uint64_t>::max(), fps, speed);
  schedule.count_ = schedule.last_;
  return schedule;
}

std::uint64_t FrameSchedule::step_of(std::uint64_t frame) const {
  assert(frame < count_);
  if (frame + 1 == count_) return last_;
  const double offset = std::round(static_cast<double>(frame) * steps_per_frame_);
  if (offset >= static_cast<double>(last_ - first_)) return last_;
  return first_ + static_cast<std::uint64_t>(offset);
}

}  // namespace aspic
