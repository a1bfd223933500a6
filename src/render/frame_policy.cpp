#include "render/frame_policy.h"

#include <glad/gl.h>

#include <algorithm>

namespace aspic {

std::unique_ptr<FramePolicy> FramePolicy::create(const gl::Context& context) {
  return std::unique_ptr<FramePolicy>(context.info().is_software ? new FramePolicy : nullptr);
}

void FramePolicy::wait() const {
  glFinish();
}

double FramePolicy::interval(bool nothing_new, bool late, double seconds) const {
  constexpr double shortest = 1.0 / 60.0, longest = 0.1;  // s
  if (nothing_new) return longest;
  return late ? std::clamp(3.0 * seconds, shortest, longest) : shortest;
}

}  // namespace aspic
