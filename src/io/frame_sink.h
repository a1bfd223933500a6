#pragma once
// Where finished pictures go.
#include <cstddef>
#include <span>
#include <string>

#include "base/result.h"

namespace aspic {

/// Width and height of a picture [pixels].
struct PictureSize {
  int width = 1280;
  int height = 720;
  friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// Takes the pictures of a run in order. One that is destroyed before finish() leaves nothing that looks
/// whole.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// height·width·3 bytes RGB, sRGB encoded, rows from the top down. Error (io): it cannot be written; the
  /// sink takes no more.
  virtual Status write(std::span<const std::byte> rgb) = 0;
  /// Completes the output. Error (io).
  virtual Status finish() = 0;
  /// What was written, for reports.
  virtual const std::string& path() const = 0;
};

}  // namespace aspic
