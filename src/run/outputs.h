#pragma once
// The outputs of a run as plain data.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/film_format.h"
#include "io/state_sink.h"

namespace aspic {

/// A file of states.
struct StateOutput {
  std::string option;                  ///< one of state_options()
  std::string path;                    ///< empty: none
  std::optional<std::uint64_t> every;  ///< steps, ≥ 1; absent: what the format has
};

/// Pictures of a run.
struct PictureOutput {
  std::string video, frames;  ///< file and directory; empty: none
  const FilmFormat* frames_format = find_film_format("png");
  std::optional<double> fps;  ///< pictures per second shown, > 0; absent: what the formats have
  double speed = 1.0;         ///< simulated seconds per second shown, > 0
  PictureSize size;
  bool text = true;  ///< parameters and time are written on them

  bool any() const { return !video.empty() || !frames.empty(); }
};

/// The pictures per second that were asked for, or what the formats have where nothing was.
double frames_per_second(const PictureOutput& output);

/// A name in the working directory that nothing has yet: `aspic-cube-plane-0001.mp4`. `scene` is a file or a
/// built-in name; the ending may be empty.
std::string free_name(const std::string& scene, std::string_view ending);

}  // namespace aspic
