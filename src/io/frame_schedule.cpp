#include "io/frame_schedule.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace aspic {
namespace {

/// Within what steps and pictures can count, whatever the quotients overflow to.
double countable(double steps_per_frame) {
  return std::clamp(steps_per_frame, 0x1p-53, 0x1p63);
}

}  // namespace

FrameSchedule::FrameSchedule(double timestep, std::uint64_t first_step, std::uint64_t last_step, double fps,
                             double speed)
    : first_(first_step), last_(last_step), steps_per_frame_(countable(speed / fps / timestep)) {
  assert(timestep > 0.0 && fps > 0.0 && speed > 0.0 && first_step <= last_step);
  const double frames = static_cast<double>(last_ - first_) / steps_per_frame_;
  // A whole number of pictures up to rounding is meant to be whole.
  const double nearest = std::round(frames);
  const double whole =
      std::abs(frames - nearest) < 1e-9 * std::max(frames, 1.0) ? nearest : std::ceil(frames);
  count_ = static_cast<std::uint64_t>(std::min(whole, 0x1p53)) + 1;
}

FrameSchedule::FrameSchedule(std::uint64_t first_step, double steps_per_frame)
    : first_(first_step),
      last_(std::numeric_limits<std::uint64_t>::max()),
      count_(last_),
      steps_per_frame_(steps_per_frame) {}

FrameSchedule FrameSchedule::open_ended(double timestep, std::uint64_t first_step, double fps, double speed) {
  assert(timestep > 0.0 && fps > 0.0 && speed > 0.0);
  return {first_step, countable(speed / fps / timestep)};
}

std::uint64_t FrameSchedule::step_of(std::uint64_t frame) const {
  assert(frame < count_);
  if (frame + 1 == count_) return last_;
  const double offset = std::round(static_cast<double>(frame) * steps_per_frame_);
  if (offset >= static_cast<double>(last_ - first_)) return last_;
  return first_ + static_cast<std::uint64_t>(offset);
}

}  // namespace aspic
