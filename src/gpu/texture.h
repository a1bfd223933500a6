#pragma once
// Two-dimensional images in device memory, and drawing into them.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu/name.h"

namespace aspic::gl {

/// How a texel is stored.
enum class TexelFormat {
  r8,       ///< one channel 0…1
  srgba8,   ///< color encoded as sRGB, linear to shaders and blending; alpha linear
  r16f,     ///< one half float
  rg16f,    ///< two half floats
  rgba16f,  ///< four
  rg32ui,   ///< two unsigned integers, to be drawn into and read back, not filtered
  depth32f
};

/// What happens outside the image.
enum class Wrap { repeat, clamp };

struct TextureSettings {
  TexelFormat format = TexelFormat::srgba8;
  int width = 1, height = 1;  ///< [texels], ≥ 1
  int samples = 1;            ///< > 1: multisampled, never filtered
  bool mipmaps = false;       ///< a full chain, filled by generate_mipmaps()
  Wrap wrap = Wrap::clamp;
};

/// A part of an image: columns left … right − 1 and rows bottom … top − 1, counted from its lower left
/// corner.
struct PixelBox {
  int left = 0, bottom = 0, right = 0, top = 0;
  bool empty() const { return left >= right || bottom >= top; }
  std::int64_t area() const { return empty() ? 0 : std::int64_t{right - left} * (top - bottom); }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Owns one GL texture of fixed size, filtered linearly. Movable; its context must outlive it and be current.
class Texture {
 public:
  /// An empty handle: id 0.
  Texture() = default;

  /// Allocates an image of undefined content. `name` appears in errors and debug messages.
  /// Errors: scene_rejected (larger than the device's images, or no memory left), no_device (the device
  /// cannot take that many samples).
  static Result<Texture> create(Context& context, std::string name, const TextureSettings& settings);

  /// Writes level 0, rows from the bottom up without padding: width·height texels of 1 (r8) or 4 (srgba8)
  /// bytes. No other format may be uploaded.
  void upload(std::span<const std::byte> texels);
  void generate_mipmaps();
  /// Copies a part of an image of the same format, size and samples, to the same place, bit by bit.
  void copy_from(const Texture& source, const PixelBox& box);
  /// Binds it to a texture unit, for a sampler of that binding number.
  void bind(std::uint32_t unit) const;

  std::uint32_t id() const { return name_.id(); }
  int width() const { return settings_.width; }
  int height() const { return settings_.height; }
  const TextureSettings& settings() const { return settings_; }

 private:
  Name name_;
  TextureSettings settings_;
};

/// Owns one GL framebuffer object over textures of equal size. Movable; context and textures must outlive it.
class Framebuffer {
 public:
  /// An empty handle: id 0, which is GL's own name for a window's framebuffer.
  Framebuffer() = default;

  /// Joins a color texture and, unless null, a depth texture.
  /// Error (no_device): the driver cannot draw into this combination.
  static Result<Framebuffer> create(Context& context, const Texture& color, const Texture* depth);

  /// Draws go here from now on, to all of it.
  void bind() const;
  /// Copies the color of `source`: resolves samples where it has more than one (sizes must agree then),
  /// filters linearly where sizes differ. Does not bind.
  void copy_color_from(const Framebuffer& source) const;
  /// The same for a part of framebuffers of one size.
  void copy_color_from(const Framebuffer& source, const PixelBox& box) const;

  /// Copies the color of `source`, of one sample, to a place within [pixels from left and bottom], values as
  /// stored. Does not bind.
  void place(const Framebuffer& source, int left, int bottom) const;
  /// Fills the color with zeros. Does not bind.
  void clear() const;
  /// Fills a part with a color as it is stored, opaque. Does not bind.
  void fill(const PixelBox& box, const std::array<float, 3>& stored) const;

  std::uint32_t id() const { return name_.id(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Name name_;
  int width_ = 0, height_ = 0;
};

}  // namespace aspic::gl
