#include "variants/common_clock.h"

#include <algorithm>
#include <utility>

#include "variants/run_length.h"

namespace aspic {

Result<std::uint64_t> as_long_as(const SimulationSettings& first, std::uint64_t steps,
                                 const SimulationSettings& run) {
  if (run.timestep == first.timestep) return steps;
  return steps_of({{}, static_cast<double>(steps) * first.timestep}, run);
}

CommonClock::CommonClock(std::vector<Span> runs, double fps, double speed)
    : runs_(std::move(runs)),
      count_(FrameSchedule(runs_.front().timestep, 0, runs_.front().last_step, fps, speed).count()) {
  for (const Span& run : runs_) schedules_.push_back(FrameSchedule::open_ended(run.timestep, 0, fps, speed));
}

std::uint64_t CommonClock::step_of(std::size_t run, std::uint64_t frame) const {
  const std::uint64_t last = runs_[run].last_step;
  return frame + 1 == count_ ? last : std::min(schedules_[run].step_of(frame), last);
}

}  // namespace aspic
