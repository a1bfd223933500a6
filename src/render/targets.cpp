#include "render/targets.h"

#include <algorithm>

namespace aspic {

Result<DrawableImage> DrawableImage::create(gl::Context& context, const std::string& name,
                                            const gl::TextureSettings& settings, bool with_depth) {
  DrawableImage image;
  ASPIC_TRY(auto colour, gl::Texture::create(context, name, settings));
  image.colour = std::move(colour);
  if (with_depth) {
    gl::TextureSettings depth = settings;
    depth.format = gl::TexelFormat::depth32f;
    depth.mipmaps = false;
    ASPIC_TRY(image.depth, gl::Texture::create(context, name + " depth", depth));
  }
  ASPIC_TRY(image.framebuffer,
            gl::Framebuffer::create(context, &image.colour, with_depth ? &image.depth : nullptr));
  return image;
}

Result<PictureTargets> PictureTargets::create(gl::Context& context, int width, int height, int samples) {
  PictureTargets targets;
  Status status;
  const auto make = [&](DrawableImage& into, const std::string& name, const gl::TextureSettings& settings,
                        bool depth) {
    if (!status) return;
    auto made = DrawableImage::create(context, name, settings, depth);
    if (made)
      into = std::move(*made);
    else
      status = made.error();
  };
  const int half_width = std::max(width / 2, 1), half_height = std::max(height / 2, 1);
  make(targets.samples, "picture samples", {.width = width, .height = height, .samples = samples}, true);
  make(targets.picture, "picture", {.width = width, .height = height}, false);
  make(targets.behind, "behind", {.width = half_width, .height = half_height}, false);
  make(targets.thickness, "thickness",
       {.format = gl::TexelFormat::r16f, .width = half_width, .height = half_height}, false);
  if (!status) return status.error();
  return targets;
}

}  // namespace aspic
