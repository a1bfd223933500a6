#pragma once
// A film of what the window shows of the scene.
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "gpu/pixel_ring.h"
#include "io/frame_sink.h"

namespace aspic::app {

/// Takes every picture of the scene that is drawn while it moves, all of one size. One that is destroyed
/// before finish() leaves no film.
class Recording {
 public:
  /// A film in `path`: .mp4, .webm or .gif by its end, or numbered PNG files into a directory of that name
  /// where it has no end. Pictures are shown at 60 a second (GIF: 50). `size` is made even where the format
  /// wants that. Errors: those of open_video and open_frame_directory; scene_rejected (no device memory).
  static Result<std::unique_ptr<Recording>> start(gl::Context& context, const std::string& path,
                                                  PictureSize size);

  const PictureSize& size() const { return size_; }
  const std::string& path() const { return path_; }
  std::uint64_t pictures() const { return pictures_; }

  /// Takes a picture of size(). Error (io): it cannot be written; the film is lost.
  Status add(const gl::Framebuffer& picture);
  /// Completes the film. Error (io).
  Status finish();

 private:
  Recording(gl::PixelRing ring, std::unique_ptr<FrameSink> sink, std::string path, PictureSize size)
      : ring_(std::move(ring)), sink_(std::move(sink)), path_(std::move(path)), size_(size) {}
  Status hand_on();

  gl::PixelRing ring_;
  std::unique_ptr<FrameSink> sink_;
  std::string path_;
  PictureSize size_;
  std::uint64_t pictures_ = 0;
  std::vector<std::byte> pixels_;
};

}  // namespace aspic::app
