#pragma once
// The images a picture is made in.
#include "base/result.h"
#include "gpu/texture.h"

namespace aspic {

/// A texture that can be drawn into.
struct DrawableImage {
  gl::Texture colour, depth;
  gl::Framebuffer framebuffer;

  /// `with_depth` adds a depth image of the same size and samples.
  static Result<DrawableImage> create(gl::Context& context, const std::string& name,
                                      const gl::TextureSettings& settings, bool with_depth);
};

/// Images for pictures of one size.
struct PictureTargets {
  DrawableImage samples;    ///< several samples per pixel, with depth
  DrawableImage picture;    ///< one sample, the finished picture
  DrawableImage behind;     ///< half size: the scene behind translucent bodies
  DrawableImage shade;      ///< half size: shares of sun and sky that bodies keep from a plane
  DrawableImage thickness;  ///< half size: length of the sight line within bodies [m]

  /// Errors (scene_rejected, no_device): those of Texture and Framebuffer.
  static Result<PictureTargets> create(gl::Context& context, int width, int height, int samples);
  /// Others of the same size and samples. Errors as create().
  Result<PictureTargets> another(gl::Context& context) const {
    return create(context, box().right, box().top, samples.colour.settings().samples);
  }
  bool is_like(const PictureTargets& other) const {
    return box() == other.box() &&
           samples.colour.settings().samples == other.samples.colour.settings().samples;
  }
  /// All of the picture.
  gl::PixelBox box() const { return {0, 0, picture.colour.width(), picture.colour.height()}; }
};

}  // namespace aspic
