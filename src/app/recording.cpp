#include "app/recording.h"

#include <algorithm>
#include <filesystem>

#include "io/frame_directory.h"
#include "io/video_file.h"

namespace aspic::app {

Result<std::unique_ptr<Recording>> Recording::start(gl::Context& context, const std::string& path,
                                                    PictureSize size) {
  const bool film = std::filesystem::path(path).has_extension();
  if (film) {
    // Colour at half resolution wants even sides.
    size.width = std::max(size.width & ~1, 16);
    size.height = std::max(size.height & ~1, 16);
  }
  const auto open = [&]() -> Result<std::unique_ptr<FrameSink>> {
    if (!film) return open_frame_directory(path, ImageFormat::png, size, Overwrite::refuse);
    const auto format = video_format_of(path);
    if (!format) return format.error();
    return open_video(path, size, default_fps(*format), Overwrite::refuse);
  };
  auto sink = open();
  if (!sink) return sink.error();
  auto ring = gl::PixelRing::create(context, size.width, size.height);
  if (!ring) return ring.error();
  return std::unique_ptr<Recording>(new Recording(std::move(*ring), std::move(*sink), path, size));
}

Status Recording::hand_on() {
  if (const Status taken = ring_.take(pixels_); !taken) return taken;
  return sink_->write(pixels_);
}

Status Recording::add(const gl::Framebuffer& picture) {
  if (ring_.full()) {
    if (const Status handed = hand_on(); !handed) return handed;
  }
  ring_.submit(picture);
  ++pictures_;
  return {};
}

Status Recording::finish() {
  while (ring_.pending() > 0) {
    if (const Status handed = hand_on(); !handed) return handed;
  }
  return sink_->finish();
}

}  // namespace aspic::app
