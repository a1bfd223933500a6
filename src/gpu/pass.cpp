#include "gpu/pass.h"

#include <glad/gl.h>

#include <cassert>

namespace aspic::gl {
namespace {

void bind(const Binding& b) {
  assert(b.buffer);
  b.buffer->bind(b.kind, b.binding, b.offset, b.bytes);
}

}  // namespace

std::uint32_t barrier_bits(ReadBy readers) {
  const auto set = [&](ReadBy r) {
    return (static_cast<std::uint32_t>(readers) & static_cast<std::uint32_t>(r)) != 0;
  };
  GLbitfield bits = 0;
  if (set(ReadBy::compute_pass)) bits |= GL_SHADER_STORAGE_BARRIER_BIT;
  if (set(ReadBy::uniform)) bits |= GL_UNIFORM_BARRIER_BIT;
  if (set(ReadBy::vertex_draw)) bits |= GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT;
  if (set(ReadBy::indirect)) bits |= GL_COMMAND_BARRIER_BIT;
  if (set(ReadBy::read_back) || set(ReadBy::copy)) bits |= GL_BUFFER_UPDATE_BARRIER_BIT;
  return bits;
}

void barrier(ReadBy readers) {
  glMemoryBarrier(barrier_bits(readers));
}

GroupCount groups_for(std::uint32_t count, std::uint32_t group_size) {
  assert(group_size >= 1);
  if (count == 0) return {};
  const std::uint32_t groups = (count - 1) / group_size + 1;
  if (groups <= max_groups_x) return {groups, 1};
  const std::uint32_t y = (groups - 1) / max_groups_x + 1;
  assert(y <= max_groups_x);
  return {(groups - 1) / y + 1, y};
}

void Pass::prepare(std::span<const Binding> extra) const {
  glUseProgram(program_->id());
  for (const Binding& b : bindings_) bind(b);
  for (const Binding& b : extra) bind(b);
}

void Pass::dispatch_for(std::uint32_t count, std::span<const Binding> extra, ReadBy readers) const {
  if (count == 0 || program_->id() == 0 || !program_->context().begins_dispatch()) return;
  prepare(extra);
  const GroupCount groups = groups_for(count, program_->group_size()[0]);
  glDispatchCompute(groups.x, groups.y, 1);
  barrier(readers);
}

void Pass::dispatch_indirect(const Buffer& arguments, std::uint64_t offset,
                             std::span<const Binding> extra) const {
  assert(offset % 4 == 0 && offset + 12 <= arguments.bytes());
  if (!program_->context().begins_dispatch()) return;
  prepare(extra);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments.id());
  glDispatchComputeIndirect(static_cast<GLintptr>(offset));
  barrier(readers_);
}

}  // namespace aspic::gl
