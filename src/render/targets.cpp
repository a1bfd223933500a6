#include "render/targets.h"

#include <algorithm>

namespace aspic {

Result<DrawableImage> DrawableImage::create(gl::Context& context, const std::string& name,
                                            const gl::TextureSettings& settings, bool with_depth) {
  DrawableImage image;
  ASPIC_TRY(image.color, gl::Texture::create(context, name, settings));
  if (with_depth) {
    gl::TextureSettings depth = settings;
    depth.format = gl::TexelFormat::depth32f;
    depth.mipmaps = false;
    ASPIC_TRY(image.depth, gl::Texture::create(context, name + " depth", depth));
  }
  ASPIC_TRY(image.framebuffer,
            gl::Framebuffer::create(context, image.color, with_depth ? &image.depth : nullptr));
  return image;
}

Result<ImageTargets> ImageTargets::create(gl::Context& context, int width, int height, int samples) {
  ImageTargets targets;
  const int half_width = std::max(width / 2, 1), half_height = std::max(height / 2, 1);
  const auto make = [&](const char* name, const gl::TextureSettings& settings, bool depth = false) {
    return DrawableImage::create(context, name, settings, depth);
  };
  ASPIC_TRY(targets.samples,
            make("image samples", {.width = width, .height = height, .samples = samples}, true));
  ASPIC_TRY(targets.image, make("image", {.width = width, .height = height}));
  ASPIC_TRY(targets.behind, make("behind", {.width = half_width, .height = half_height}));
  ASPIC_TRY(targets.shade,
            make("shade", {.format = gl::TexelFormat::rg16f, .width = half_width, .height = half_height}));
  ASPIC_TRY(targets.thickness,
            make("thickness", {.format = gl::TexelFormat::r16f, .width = half_width, .height = half_height}));
  return targets;
}

}  // namespace aspic
