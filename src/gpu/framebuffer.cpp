#include "gpu/framebuffer.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <cassert>

namespace aspic::gl {

Result<Framebuffer> Framebuffer::create(Context& context, const Texture* colour, const Texture* depth) {
  assert(colour || depth);
  const Texture& any = colour ? *colour : *depth;
  Framebuffer result;
  result.width_ = any.width();
  result.height_ = any.height();
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  result.name_ = Name(id, [](std::uint32_t owned) { glDeleteFramebuffers(1, &owned); });
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  if (colour) glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, colour->id(), 0);
  if (depth) glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth->id(), 0);
  if (!colour) {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return fail(ErrorCode::no_device,
                "{} cannot draw into an image of {} x {} pixels with {} sample{} (framebuffer "
                "status 0x{:04x}).",
                context.info().renderer, any.width(), any.height(), any.settings().samples,
                any.settings().samples == 1 ? "" : "s", status);
  return result;
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::copy_colour_from(const Framebuffer& source) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  const bool same = source.width_ == width_ && source.height_ == height_;
  glBlitFramebuffer(0, 0, source.width_, source.height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                    same ? GL_NEAREST : GL_LINEAR);
}

}  // namespace aspic::gl
