#pragma once
// One clock for runs of different time steps.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aspic/settings.h"
#include "base/result.h"
#include "io/frame_schedule.h"

namespace aspic {

/// The step of a run that lasts as long as `steps` steps of `first`, to its nearest step. Error (usage): more
/// steps than can be counted.
Result<std::uint64_t> as_long_as(const SimulationSettings& first, std::uint64_t steps,
                                 const SimulationSettings& run);

/// How far a run with its own time step goes.
struct Span {
  double timestep = 0.0;        ///< [s], > 0
  std::uint64_t last_step = 0;  ///< where it ends
};

/// The state of each run that a frame shows: the step nearest to the frame's time, at most half a time step
/// away; in the last frame the last step. The first run determines the number of frames.
class CommonClock {
 public:
  /// At least one run, each from step 0. fps and speed as of FrameSchedule.
  CommonClock(std::vector<Span> runs, double fps, double speed);
  /// Number of frames, ≥ 1.
  std::uint64_t count() const { return count_; }
  /// The step of run `run` in frame `frame` < count(); never decreases.
  std::uint64_t step_of(std::size_t run, std::uint64_t frame) const;

 private:
  std::vector<Span> runs_;
  std::vector<FrameSchedule> schedules_;
  std::uint64_t count_;
};

}  // namespace aspic
