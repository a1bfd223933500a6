#pragma once
// Images on their way back from the device, several at once, so that nobody waits for the newest.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu/fence.h"
#include "gpu/name.h"
#include "gpu/texture.h"

namespace aspic::gl {

/// A buffer for pixels on their way back.
Name pixel_buffer(Context& context, std::size_t bytes);

/// The color of a framebuffer of one sample as it is when all calls so far are done, at once: into
/// height·width·3 bytes as PixelRing::take() gives them. `scratch` is room that is kept between calls. Error
/// (no_device): the device was lost, or the context is in use on another thread.
Status read_rgb(Context& context, const Framebuffer& source, std::vector<std::byte>& scratch,
                std::span<std::byte> rgb);

/// A ring of pixel buffers with fences, for images of one size. OpenGL 4.3 has no persistent mapping, so a
/// buffer is mapped when its fence has passed. Its context must outlive it; every call makes it current.
class PixelRing {
 public:
  /// Images under way at once.
  static constexpr std::size_t capacity = 3;

  /// Makes the buffers. Error (scene_rejected): no device memory for them.
  static Result<PixelRing> create(Context& context, int width, int height);

  bool full() const { return pending_ == capacity; }
  std::size_t pending() const { return pending_; }

  /// Queues the read-back of the framebuffer's color as it will be when all calls so far are done; legal
  /// unless full(). The framebuffer must have the ring's size and one sample.
  void submit(const Framebuffer& source);

  /// The oldest image: height·width·3 bytes RGB, rows from the top down, values as stored (of an sRGB
  /// image: encoded). Waits for the device. Legal while pending() > 0. Error (no_device): the device was
  /// lost, or the context is in use on another thread.
  Status take(std::vector<std::byte>& rgb);

 private:
  PixelRing() = default;
  Context* context_ = nullptr;
  int width_ = 0, height_ = 0;
  std::array<Name, capacity> buffers_;
  std::array<Fence, capacity> fences_;
  std::size_t first_ = 0, pending_ = 0;
};

}  // namespace aspic::gl
