#include "gpu_solver/pull_buffer.h"

#include <span>

#include "device/particles.h"

namespace aspic {
namespace {

layout::Pull block_of(const std::optional<Pull>& pull) {
  layout::Pull block{};
  block.particle = NO_BODY;
  if (!pull) return block;
  block.anchor = rounded(pull->anchor, 0.0);
  block.stiffness = static_cast<float>(pull->stiffness);
  block.damping = static_cast<float>(pull->damping);
  block.particle = pull->particle;
  return block;
}

}  // namespace

Status PullBuffer::build(gl::Context& context) {
  const layout::Pull block = block_of(std::nullopt);
  ASPIC_TRY(buffer_, gl::Buffer::of(context, "pull", std::span(&block, 1), gl::BufferKind::uniform));
  return {};
}

Status PullBuffer::set(const Model& model, const std::optional<Pull>& pull) {
  ASPIC_TRY(const std::optional<Pull> taken, rounded_pull(model, pull, Precision::single));
  if (taken == pull_) return {};
  pull_ = taken;
  const layout::Pull block = block_of(pull_);
  buffer_.upload_items(std::span<const layout::Pull>(&block, 1));
  return {};
}

}  // namespace aspic
