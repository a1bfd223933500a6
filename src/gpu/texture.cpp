#include "gpu/texture.h"

#include <glad/gl.h>

#include <algorithm>
#include <bit>
#include <cassert>

namespace aspic::gl {
namespace {

struct Storage {
  GLenum internal;
  GLenum format;  // of uploads
  std::size_t upload_bytes;
};

/// By TexelFormat.
constexpr Storage storages[] = {
    {GL_R8, GL_RED, 1}, {GL_SRGB8_ALPHA8, GL_RGBA, 4}, {GL_R16F, 0, 0}, {GL_RG16F, 0, 0}, {GL_RGBA16F, 0, 0},
    {GL_RG32UI, 0, 0},  {GL_DEPTH_COMPONENT32F, 0, 0}};

const Storage& storage_of(TexelFormat format) {
  return storages[static_cast<std::size_t>(format)];
}

GLenum target_of(const TextureSettings& settings) {
  return settings.samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
}

}  // namespace

Result<Texture> Texture::create(Context& context, std::string name, const TextureSettings& settings) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (settings.width < 1 || settings.height < 1 || settings.width > largest || settings.height > largest)
    return fail(ErrorCode::scene_rejected,
                "Cannot make the image \"{}\" of {} x {} pixels: {} takes 1 to {} along each side. Choose "
                "another image size.",
                name, settings.width, settings.height, context.info().renderer, largest);
  if (settings.samples > 1) {
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    if (settings.samples > most)
      return fail(ErrorCode::no_device, "{} takes at most {} samples per pixel, not {}.",
                  context.info().renderer, most, settings.samples);
  }
  context.forget_errors();
  Texture texture;
  texture.settings_ = settings;
  GLuint id = 0;
  glGenTextures(1, &id);
  texture.name_ = Name(context, id, [](std::uint32_t owned) { glDeleteTextures(1, &owned); });
  const GLenum target = target_of(settings);
  const Storage storage = storage_of(settings.format);
  glBindTexture(target, id);
  if (settings.samples > 1) {
    glTexStorage2DMultisample(target, settings.samples, storage.internal, settings.width, settings.height,
                              GL_TRUE);
  } else {
    const auto side = static_cast<unsigned>(std::max(settings.width, settings.height));
    glTexStorage2D(target, settings.mipmaps ? static_cast<GLsizei>(std::bit_width(side)) : 1,
                   storage.internal, settings.width, settings.height);
    const GLint wrap = settings.wrap == Wrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, settings.mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  const GLenum error = context.strikes(Fault::out_of_memory) ? GL_OUT_OF_MEMORY : glGetError();
  if (error != GL_NO_ERROR && context.lost()) return context.lost_error();
  if (error != GL_NO_ERROR)
    return fail(ErrorCode::scene_rejected,
                "{} has no memory for the image \"{}\" of {} x {} pixels with {} sample{} (GL error "
                "0x{:04x}). Choose a smaller image.",
                context.info().renderer, name, settings.width, settings.height, settings.samples,
                settings.samples == 1 ? "" : "s", error);
  if (context.info().debug && !name.empty())
    glObjectLabel(GL_TEXTURE, id, static_cast<GLsizei>(name.size()), name.data());
  return texture;
}

void Texture::upload(std::span<const std::byte> texels) {
  const Storage storage = storage_of(settings_.format);
  assert(storage.upload_bytes > 0 && settings_.samples == 1);
  assert(texels.size() == storage.upload_bytes * static_cast<std::size_t>(settings_.width) *
                              static_cast<std::size_t>(settings_.height));
  glBindTexture(GL_TEXTURE_2D, id());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, settings_.width, settings_.height, storage.format, GL_UNSIGNED_BYTE,
                  texels.data());
}

void Texture::generate_mipmaps() {
  assert(settings_.mipmaps);
  glBindTexture(GL_TEXTURE_2D, id());
  glGenerateMipmap(GL_TEXTURE_2D);
}

void Texture::copy_from(const Texture& source, const PixelBox& box) {
  assert(source.settings_.format == settings_.format && source.settings_.samples == settings_.samples);
  assert(source.width() == width() && source.height() == height());
  if (box.empty()) return;
  const GLenum target = target_of(settings_);
  glCopyImageSubData(source.id(), target, 0, box.left, box.bottom, 0, id(), target, 0, box.left, box.bottom,
                     0, box.right - box.left, box.top - box.bottom, 1);
}

void Texture::bind(std::uint32_t unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target_of(settings_), id());
  glActiveTexture(GL_TEXTURE0);
}

Result<Framebuffer> Framebuffer::create(Context& context, const Texture& color, const Texture* depth) {
  Framebuffer result;
  result.width_ = color.width();
  result.height_ = color.height();
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  result.name_ = Name(context, id, [](std::uint32_t owned) { glDeleteFramebuffers(1, &owned); });
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color.id(), 0);
  if (depth) glFramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth->id(), 0);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return fail(ErrorCode::no_device,
                "{} cannot draw into an image of {} x {} pixels with {} sample{} (framebuffer "
                "status 0x{:04x}).",
                context.info().renderer, color.width(), color.height(), color.settings().samples,
                color.settings().samples == 1 ? "" : "s", status);
  return result;
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::copy_color_from(const Framebuffer& source) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  const bool same = source.width_ == width_ && source.height_ == height_;
  glBlitFramebuffer(0, 0, source.width_, source.height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                    same ? GL_NEAREST : GL_LINEAR);
}

void Framebuffer::copy_color_from(const Framebuffer& source, const PixelBox& box) const {
  assert(source.width_ == width_ && source.height_ == height_);
  if (box.empty()) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  glBlitFramebuffer(box.left, box.bottom, box.right, box.top, box.left, box.bottom, box.right, box.top,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Framebuffer::place(const Framebuffer& source, int left, int bottom) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  glBlitFramebuffer(0, 0, source.width_, source.height_, left, bottom, left + source.width_,
                    bottom + source.height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Framebuffer::clear() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  const GLfloat nothing[4] = {};
  glClearBufferfv(GL_COLOR, 0, nothing);
}

void Framebuffer::fill(const PixelBox& box, const std::array<float, 3>& stored) const {
  if (box.empty()) return;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, id());
  glEnable(GL_SCISSOR_TEST);
  glScissor(box.left, box.bottom, box.right - box.left, box.top - box.bottom);
  const GLfloat color[4] = {stored[0], stored[1], stored[2], 1.0f};
  glClearBufferfv(GL_COLOR, 0, color);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace aspic::gl
