#include "gpu/buffer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/printable.h"
#include "gpu/current.h"
#include "gpu/read_ring.h"

namespace aspic::gl {
namespace {

// The copy targets belong to no indexed binding point, so that working on a buffer disturbs no pass.
constexpr GLenum target = GL_COPY_WRITE_BUFFER;
constexpr std::uint64_t token_bytes = 16;

}  // namespace

Status Buffer::check_size(const Context& context, std::string_view name, std::uint64_t bytes,
                          BufferKind kind) {
  const DeviceLimits& limits = context.info().limits;
  const bool storage = kind != BufferKind::uniform;
  const std::uint64_t limit =
      storage ? std::min(limits.storage_block_bytes, limits.buffer_bytes) : limits.uniform_block_bytes;
  if (bytes <= limit) return {};
  return advised(
      fail(ErrorCode::scene_rejected,
           "The {} buffer \"{}\" needs {} ({} bytes), but {} takes blocks of {} ({} bytes) at most.",
           storage ? "storage" : "uniform", name, human_bytes(bytes), bytes, context.info().renderer,
           human_bytes(limit), limit),
      {advice("make the scene smaller"), use_backend("cpu"), advice("choose another device")});
}

Result<Buffer> Buffer::create(Context& context, std::string name, std::uint64_t bytes, BufferKind kind) {
  const Current here(context);
  ASPIC_CHECK(here.status());
  ASPIC_CHECK(check_size(context, name, bytes, kind));
  const bool storage = kind != BufferKind::uniform;
  // An error from before would be taken for this allocation's; on debug contexts the message was kept.
  context.forget_errors();
  std::uint32_t id = 0;
  glGenBuffers(1, &id);
  Buffer buffer;
  buffer.held_ = {&context, {id, 0}};
  glBindBuffer(target, id);
  glBufferData(target, static_cast<GLsizeiptr>(std::max(bytes, token_bytes)), nullptr,
               storage ? GL_DYNAMIC_COPY : GL_DYNAMIC_DRAW);
  const GLenum error = context.strikes(Fault::out_of_memory) ? GL_OUT_OF_MEMORY : glGetError();
  if (error != GL_NO_ERROR && context.lost()) return context.lost_error();
  if (error != GL_NO_ERROR)
    return fail(ErrorCode::scene_rejected,
                "{} has no memory for the {} buffer \"{}\" of {} ({} bytes), with {} held already (GL "
                "error 0x{:04x}). Make the scene smaller, or close other programs that use the device.",
                context.info().renderer, storage ? "storage" : "uniform", name, human_bytes(bytes), bytes,
                human_bytes(context.bytes_held()), error);
  if (context.info().debug && !name.empty())
    glObjectLabel(GL_BUFFER, id, static_cast<GLsizei>(name.size()), name.data());
  buffer.held_.get_deleter().bytes = bytes;
  context.bytes_held_ += bytes;
  return buffer;
}

void Buffer::Release::operator()(Context* context) const {
  context->dispose({nullptr, id, nullptr, bytes});
}

void Buffer::upload(std::span<const std::byte> data, std::uint64_t offset) {
  assert(offset <= bytes() && data.size() <= bytes() - offset);
  if (data.empty()) return;
  glBindBuffer(target, id());
  glBufferSubData(target, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(data.size()), data.data());
}

namespace {

/// One part is read while the next ones are copied. `take`: offset of the part in `bytes`, its size.
template <class Take>
void for_each_part(const Buffer& source, ReadRing& ring, std::uint64_t offset, std::uint64_t bytes,
                   const Take& take) {
  const auto part = [&](std::uint64_t at) { return std::min(bytes - at, read_part_bytes); };
  for (std::uint64_t at = 0, asked = 0; at < bytes; at += part(at)) {
    for (; asked < bytes && !ring.full(); asked += part(asked))
      ring.submit(source, offset + asked, part(asked));
    take(at, part(at));
  }
}

}  // namespace

void Buffer::download(std::span<std::byte> data, std::uint64_t offset) const {
  assert(offset <= bytes() && data.size() <= bytes() - offset);
  ReadRing& ring = held_->reads();
  for_each_part(*this, ring, offset, data.size(),
                [&](std::uint64_t at, std::uint64_t size) { ring.take(data.subspan(at, size)); });
}

void Buffer::read_parts(std::uint64_t bytes, const ReadPart& read) const {
  assert(bytes <= this->bytes());
  ReadRing& ring = held_->reads();
  for_each_part(*this, ring, 0, bytes, [&](std::uint64_t at, std::uint64_t size) {
    ring.take(size, [&](std::span<const std::byte> part) { read(part, at); });
  });
}

void Buffer::bind(BufferKind kind, std::uint32_t binding, std::uint64_t offset, std::uint64_t bytes) const {
  assert(bytes == 0 ? offset == 0 : offset <= this->bytes() && bytes <= this->bytes() - offset);
  if (!held_) return;  // a kernel that is given no buffer reads none
  const bool storage = kind != BufferKind::uniform;
  auto& points = held_->bound_[storage ? 0 : 1];
  const Context::Bound wanted = {id(), offset, bytes};
  if (binding < points.size()) {
    if (points[binding] == wanted) return;
    points[binding] = wanted;
  }
  const GLenum point = storage ? GL_SHADER_STORAGE_BUFFER : GL_UNIFORM_BUFFER;
  if (bytes == 0)
    glBindBufferBase(point, binding, id());
  else
    glBindBufferRange(point, binding, id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes));
}

void Buffer::clear() {
  if (bytes() == 0) return;
  glBindBuffer(target, id());
  glClearBufferData(target, GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
}

}  // namespace aspic::gl
