#pragma once
// How images are drawn where that is dear: by a software rasterizer, on the processors that simulate.
#include <memory>

#include "gpu/context.h"
#include "render/resolution.h"

namespace aspic {

/// Of one renderer. Hardware has none: it draws each image completely, at once and in full resolution, and
/// keeps nothing of it.
class FramePolicy {
 public:
  /// That of a context's device; null: hardware.
  static std::unique_ptr<FramePolicy> create(const gl::Context& context);

  /// Of images of what moves; what is at rest is drawn finely.
  Resolution resolution;
  /// What steps between two images may take [s]: an image takes longer anyway.
  static constexpr double step_seconds = 0.030;
  /// The same where there is no policy.
  static constexpr double hardware_step_seconds = 0.012;

  /// Waits until all that was begun is drawn: the time since then is the image's.
  void wait() const;
  /// From one image to the next [s]: no more of them than a display shows, only what is new, and where
  /// steps are late a third of the time at most. The last one took `seconds`.
  double interval(bool nothing_new, bool late, double seconds) const;

 private:
  FramePolicy() = default;
};

}  // namespace aspic
