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
  DrawableImage behind;     ///< half size: what is behind translucent bodies
  DrawableImage thickness;  ///< half size: what a sight line crosses of bodies [m]

  /// Errors (scene_rejected, no_device): those of Texture and Framebuffer.
  static Result<PictureTargets> create(gl::Context& context, int width, int height, int samples);
};

}  // namespace aspic
