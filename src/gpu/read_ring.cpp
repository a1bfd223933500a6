#include "gpu/read_ring.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace aspic::gl {
namespace {

// The copy targets belong to no indexed binding point, so that reading disturbs no pass.
constexpr GLenum source_target = GL_COPY_READ_BUFFER;
constexpr GLenum drain_target = GL_COPY_WRITE_BUFFER;

}  // namespace

ReadRing::ReadRing(Context& context, std::uint64_t bytes) : context_(&context), fences_(capacity) {
  for (std::size_t n = 0; n < capacity; ++n) {
    GLuint id = 0;
    glGenBuffers(1, &id);
    glBindBuffer(drain_target, id);
    glBufferData(drain_target, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    buffers_.emplace_back(context, id, [](std::uint32_t owned) { glDeleteBuffers(1, &owned); });
  }
}

void ReadRing::submit(const Buffer& source, std::uint64_t offset, std::uint64_t bytes) {
  assert(!full() && offset <= source.bytes() && bytes <= source.bytes() - offset);
  const std::size_t slot = (first_ + pending_) % capacity;
  glBindBuffer(drain_target, buffers_[slot].id());
  glBindBuffer(source_target, source.id());
  glCopyBufferSubData(source_target, drain_target, static_cast<GLintptr>(offset), 0,
                      static_cast<GLsizeiptr>(bytes));
  fences_[slot] = fence(*context_);
  ++pending_;
}

bool ReadRing::ready() {
  assert(pending_ > 0);
  return context_->dead_ || passed(*context_, fences_[first_]);
}

void ReadRing::take(std::span<std::byte> data) {
  const auto copy = [&](std::span<const std::byte> arrived) { std::ranges::copy(arrived, data.begin()); };
  // What a lost device answers is anything; this is the least likely to pass for a result.
  if (!take(data.size(), copy)) std::ranges::fill(data, std::byte{0xff});
}

bool ReadRing::take(std::uint64_t bytes, const std::function<void(std::span<const std::byte>)>& read) {
  assert(pending_ > 0);
  const std::size_t slot = first_;
  first_ = (first_ + 1) % capacity;
  --pending_;
  const Fence arrived = std::move(fences_[slot]);
  if (context_->dead_ || !wait_for(*context_, arrived)) return false;
  glBindBuffer(drain_target, buffers_[slot].id());
  const auto* const data = static_cast<const std::byte*>(
      glMapBufferRange(drain_target, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT));
  if (!data) return false;
  read({data, bytes});
  return glUnmapBuffer(drain_target) == GL_TRUE;
}

void ReadRing::forget() {
  for (Fence& fence : fences_) fence.reset();
  pending_ = 0;
}

}  // namespace aspic::gl
