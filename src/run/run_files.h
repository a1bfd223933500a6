#pragma once
// Names, formats and rates of what a run writes.
#include <string>
#include <string_view>
#include <vector>

#include "aspic/run.h"
#include "io/state_sink.h"
#include "io/video_format.h"

namespace aspic {

/// Whether the names of all outputs say formats that these options have. Error (usage).
Status check_endings(const std::vector<StateOutput>& outputs);

/// The frames per second of the options, or else those of the format.
double frames_per_second(const ImageOutput& output);

/// A name in the working directory that nothing has yet: `aspic-cube-plane-0001.mp4`. `scene` is a file or a
/// built-in name; the ending may be empty.
std::string free_name(const std::string& scene, std::string_view ending);

}  // namespace aspic
