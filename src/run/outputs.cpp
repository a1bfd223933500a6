#include "run/outputs.h"

#include <fmt/format.h>

#include <filesystem>

namespace aspic {

double frames_per_second(const PictureOutput& output) {
  if (output.fps) return *output.fps;
  const auto format = video_format_of(output.video);
  return format ? (*format)->default_fps : output.frames_format->default_fps;
}

std::string free_name(const std::string& scene, std::string_view ending) {
  const std::string stem = std::filesystem::path(scene).stem().string();
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("aspic-{}-{:04}{}", stem, number, ending);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

}  // namespace aspic
