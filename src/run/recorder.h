#pragma once
// The number of frames of a run.
#include <cstdint>

#include "aspic/run.h"

namespace aspic {

/// Checks the number of frames of a run. Error (usage): speed and frames per second make more than anybody
/// can have meant.
Status check_frame_count(const ImageOutput& output, double timestep, std::uint64_t first_step,
                         std::uint64_t last_step);

}  // namespace aspic
