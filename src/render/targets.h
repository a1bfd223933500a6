#pragma once
// The images an image is made in.
#include "base/result.h"
#include "gpu/texture.h"

namespace aspic {

/// A texture that can be drawn into.
struct DrawableImage {
  gl::Texture color, depth;
  gl::Framebuffer framebuffer;

  /// `with_depth` adds a depth image of the same size and samples.
  static Result<DrawableImage> create(gl::Context& context, const std::string& name,
                                      const gl::TextureSettings& settings, bool with_depth);
};

/// Images for images of one size.
struct ImageTargets {
  DrawableImage samples;    ///< several samples per pixel, with depth
  DrawableImage image;      ///< one sample, the finished image
  DrawableImage behind;     ///< half size: the scene behind translucent bodies
  DrawableImage shade;      ///< half size: shares of sun and sky that bodies keep from a plane
  DrawableImage thickness;  ///< half size: length of the sight line within bodies [m]

  /// Errors (scene_rejected, no_device): those of Texture and Framebuffer.
  static Result<ImageTargets> create(gl::Context& context, int width, int height, int samples);
  /// Others of the same size and samples. Errors as create().
  Result<ImageTargets> another(gl::Context& context) const {
    return create(context, box().right, box().top, samples.color.settings().samples);
  }
  bool is_like(const ImageTargets& other) const {
    return box() == other.box() && samples.color.settings().samples == other.samples.color.settings().samples;
  }
  /// All of the image.
  gl::PixelBox box() const { return {0, 0, image.color.width(), image.color.height()}; }
};

}  // namespace aspic
