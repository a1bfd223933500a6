#include "render/backdrop.h"

#include <glad/gl.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace aspic {

BackdropLook::BackdropLook(const render_layout::Frame& of_image, const std::vector<Terrain>& placed,
                           const std::optional<Color>& plain, int count)
    : frame(of_image), terrain(placed), background(plain), samples(count) {
  frame.shadow_tint = frame.quantity_range = {};
  frame.color_mode = frame.particle_count = 0;
  frame.see_through = 0.0f;
}

bool operator==(const BackdropLook& a, const BackdropLook& b) {
  const auto same = [](const Terrain& x, const Terrain& y) {
    return x.shape == y.shape && x.geometry.vectors == y.geometry.vectors &&
           x.geometry.numbers == y.geometry.numbers;
  };
  return a.samples == b.samples && a.background == b.background &&
         std::ranges::equal(std::as_bytes(std::span(&a.frame, 1)), std::as_bytes(std::span(&b.frame, 1))) &&
         std::equal(a.terrain.begin(), a.terrain.end(), b.terrain.begin(), b.terrain.end(), same);
}

bool Backdrop::stays(const BackdropLook& look) {
  if (look_ == look) return true;
  look_ = look;
  drawn_ = false;
  return false;
}

void Backdrop::forget() {
  look_.reset();
  images_.reset();
  drawn_ = false;
}

Status Backdrop::begin(gl::Context& context, const ImageTargets& like) {
  if (!images_ || !images_->is_like(like)) {
    images_.reset();
    ASPIC_TRY(images_, like.another(context));
  }
  images_->samples.framebuffer.bind();
  return {};
}

void Backdrop::finish() {
  resolve_samples(*images_, {images_->box()});
  drawn_ = true;
}

void Backdrop::put_samples(ImageTargets& targets, const std::vector<gl::PixelBox>& boxes) const {
  for (const gl::PixelBox& box : boxes) {
    targets.samples.color.copy_from(images_->samples.color, box);
    targets.samples.depth.copy_from(images_->samples.depth, box);
  }
}

void Backdrop::put_image(ImageTargets& targets) const {
  targets.image.color.copy_from(images_->image.color, targets.box());
}

void halve_samples(const RenderPrograms& programs, const gl::VertexArray& nothing,
                   const ImageTargets& targets, const std::vector<gl::PixelBox>& boxes) {
  const int samples = targets.samples.color.settings().samples;
  const gl::Program& program = programs.halve[samples > 1];
  if (samples > 1) program.set(LOCATION_COUNT, samples);
  targets.behind.framebuffer.bind();
  targets.samples.color.bind(UNIT_FRAME);
  nothing.bind();
  glUseProgram(program.id());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_SCISSOR_TEST);
  for (const gl::PixelBox& box : boxes) {
    // Pixels that the box touches.
    const int left = box.left / 2, bottom = box.bottom / 2;
    glScissor(left, bottom, (box.right + 1) / 2 - left, (box.top + 1) / 2 - bottom);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_DEPTH_TEST);
}

void resolve_samples(const ImageTargets& targets, const std::vector<gl::PixelBox>& boxes) {
  for (const gl::PixelBox& box : boxes)
    targets.image.framebuffer.copy_color_from(targets.samples.framebuffer, box);
}

}  // namespace aspic
