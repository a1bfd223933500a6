#include "playback/video_pace.h"

#include <algorithm>
#include <cassert>

#include "model/steps.h"

namespace aspic {

void VideoPace::count_from(std::uint64_t step) {
  schedule_ = FrameSchedule::open_ended(timestep_, step, fps_, speed_);
  frame_ = 0;
}

std::uint64_t VideoPace::take(std::uint64_t step, double timestep, double speed) {
  assert(timestep > 0.0 && speed > 0.0);
  const bool other_pace = timestep != timestep_ || speed != speed_;
  if (schedule_ && timestep != timestep_) {
    // The same times in steps of the new length. Rounded down: however the run rounds its own step, it
    // has not gone back.
    const double ratio = timestep_ / timestep;
    last_taken_ = nearest_step(static_cast<double>(last_taken_) * ratio, 1.0);
    last_seen_ =
        static_cast<std::uint64_t>(std::clamp(static_cast<double>(last_seen_) * ratio - 1.0, 0.0, 0x1p62));
  }
  timestep_ = timestep;
  speed_ = speed;
  if (!schedule_ || step < last_seen_) {
    count_from(step);
  } else if (other_pace) {
    count_from(last_taken_);
    frame_ = 1;
  }
  if (next_step() < step) count_from(step);
  last_seen_ = step;
  std::uint64_t images = 0;
  for (; next_step() == step; ++frame_) ++images;
  if (images > 0) last_taken_ = step;
  return images;
}

std::uint64_t VideoPace::next_step() const {
  return schedule_ ? schedule_->step_of(frame_) : 0;
}

}  // namespace aspic
