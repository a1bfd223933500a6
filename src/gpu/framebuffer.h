#pragma once
// Textures to draw into.
#include <cstdint>

#include "base/result.h"
#include "gpu/texture.h"

namespace aspic::gl {

/// Owns one GL framebuffer object over textures of equal size. Movable; context and textures must outlive it.
class Framebuffer {
 public:
  /// An empty handle: id 0, which is GL's own name for a window's framebuffer.
  Framebuffer() = default;

  /// Joins a colour and a depth texture; either may be null, not both.
  /// Error (no_device): the driver cannot draw into this combination.
  static Result<Framebuffer> create(Context& context, const Texture* colour, const Texture* depth);

  /// Draws go here from now on, to the whole of it.
  void bind() const;
  /// Copies the colour of `source`: resolves samples where it has more than one (sizes must agree then),
  /// filters linearly where sizes differ. Does not bind.
  void copy_colour_from(const Framebuffer& source) const;

  std::uint32_t id() const { return name_.id(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Name name_;
  int width_ = 0, height_ = 0;
};

}  // namespace aspic::gl
