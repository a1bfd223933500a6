#include "gpu/pixel_ring.h"

#include <glad/gl.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

#include "gpu/current.h"

namespace aspic::gl {
namespace {

// Four bytes a pixel go straight through; three would be repacked by the driver texel by texel.
constexpr std::size_t stored_channels = 4;

/// Pixels without their fourth channel.
void drop_alpha(const std::byte* in, std::size_t pixels, std::byte* out) {
  // Four at a time as words: a third of the time of single bytes.
  std::size_t i = 0;
  if constexpr (std::endian::native == std::endian::little) {
    for (; i + 4 <= pixels; i += 4, in += 4 * stored_channels, out += 12) {
      std::array<std::uint32_t, 4> p;
      std::memcpy(p.data(), in, sizeof p);
      const std::array<std::uint32_t, 3> packed = {(p[0] & 0xffffffu) | (p[1] << 24),
                                                   ((p[1] >> 8) & 0xffffu) | (p[2] << 16),
                                                   ((p[2] >> 16) & 0xffu) | (p[3] << 8)};
      std::memcpy(out, packed.data(), sizeof packed);
    }
  }
  for (; i < pixels; ++i, in += stored_channels, out += 3) std::memcpy(out, in, 3);
}

/// Rows from the bottom up to rows from the top down, without the fourth channel.
void put_rgb(const std::byte* pixels, std::size_t width, std::size_t height, std::byte* out) {
  for (std::size_t row = height; row-- > 0; out += 3 * width)
    drop_alpha(pixels + row * width * stored_channels, width, out);
}

/// The framebuffer's pixels to `place`, or to that place of the bound pixel buffer.
void read_pixels(const Framebuffer& source, void* place) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, source.width(), source.height(), GL_RGBA, GL_UNSIGNED_BYTE, place);
}

Error lost_image(const Context& context) {
  return fail(ErrorCode::no_device, "Cannot read back an image: the device {} was lost.",
              context.info().renderer);
}

}  // namespace

Status read_rgb(Context& context, const Framebuffer& source, std::vector<std::byte>& scratch,
                std::span<std::byte> rgb) {
  const Current here(context);
  ASPIC_CHECK(here.status());
  const auto width = static_cast<std::size_t>(source.width());
  const auto height = static_cast<std::size_t>(source.height());
  assert(rgb.size() == 3 * width * height);
  scratch.resize(stored_channels * width * height);
  read_pixels(source, scratch.data());
  if (context.lost()) return lost_image(context);
  put_rgb(scratch.data(), width, height, rgb.data());
  return {};
}

Name pixel_buffer(Context& context, std::size_t bytes) {
  GLuint id = 0;
  glGenBuffers(1, &id);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, id);
  glBufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return Name(context, id, [](std::uint32_t owned) { glDeleteBuffers(1, &owned); });
}

Result<PixelRing> PixelRing::create(Context& context, int width, int height) {
  assert(width >= 1 && height >= 1);
  const Current here(context);
  ASPIC_CHECK(here.status());
  context.forget_errors();
  PixelRing ring;
  ring.context_ = &context;
  ring.width_ = width;
  ring.height_ = height;
  const std::size_t bytes =
      stored_channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (Name& buffer : ring.buffers_) buffer = pixel_buffer(context, bytes);
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR)
    return fail(
        ErrorCode::scene_rejected,
        "{} has no memory to read back images of {} x {} pixels (GL error 0x{:04x}). Choose a smaller image.",
        context.info().renderer, width, height, error);
  return ring;
}

void PixelRing::submit(const Framebuffer& source) {
  assert(!full() && source.width() == width_ && source.height() == height_);
  const std::size_t slot = (first_ + pending_) % capacity;
  ++pending_;
  const Current here(*context_);
  if (!here.status()) return;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers_[slot].id());
  read_pixels(source, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  fences_[slot] = fence(*context_);
}

Status PixelRing::take(std::vector<std::byte>& rgb) {
  assert(pending_ > 0);
  const Current here(*context_);
  ASPIC_CHECK(here.status());
  const std::size_t slot = first_;
  const Fence drawn = std::move(fences_[slot]);
  const Status answered = wait_for(*context_, drawn);
  first_ = (first_ + 1) % capacity;
  --pending_;

  const auto width = static_cast<std::size_t>(width_);
  const auto height = static_cast<std::size_t>(height_);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffers_[slot].id());
  const auto* pixels = static_cast<const std::byte*>(
      !answered || context_->lost()
          ? nullptr
          : glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0,
                             static_cast<GLsizeiptr>(stored_channels * width * height), GL_MAP_READ_BIT));
  if (!pixels) {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    return lost_image(*context_);
  }
  rgb.resize(3 * width * height);
  put_rgb(pixels, width, height, rgb.data());
  const bool kept = glUnmapBuffer(GL_PIXEL_PACK_BUFFER) == GL_TRUE;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  if (!kept || context_->lost()) return lost_image(*context_);  // meanwhile: what was read may be anything
  return {};
}

}  // namespace aspic::gl
