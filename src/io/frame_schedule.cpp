#include "io/frame_schedule.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace aspic {

FrameSchedule::FrameSchedule(double timestep, std::uint64_t first_step, std::uint64_t last_step, double fps,
                             double speed)
    : first_(first_step), last_(last_step), steps_per_frame_(speed / fps / timestep) {
  assert(timestep > 0.0 && fps > 0.0 && speed > 0.0 && first_step <= last_step);
  const double frames = static_cast<double>(last_ - first_) / steps_per_frame_;
  // A whole number of pictures up to rounding is meant to be whole.
  const double nearest = std::round(frames);
  const double whole =
      std::abs(frames - nearest) < 1e-9 * std::max(frames, 1.0) ? nearest : std::ceil(frames);
  count_ = static_cast<std::uint64_t>(whole) + 1;
}

std::uint64_t FrameSchedule::step_of(std::uint64_t frame) const {
  assert(frame < count_);
  if (frame + 1 == count_) return last_;
  const double offset = std::round(static_cast<double>(frame) * steps_per_frame_);
  return std::min(first_ + static_cast<std::uint64_t>(offset), last_);
}

}  // namespace aspic
