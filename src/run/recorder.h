#pragma once
// How many pictures a run makes.
#include <cstdint>

#include "aspic/run.h"

namespace aspic {

/// Whether the pictures of a run can be counted. Error (usage): speed and pictures per second make more than
/// was meant.
Status check_pictures(const PictureOutput& output, double timestep, std::uint64_t first_step,
                      std::uint64_t last_step);

}  // namespace aspic
