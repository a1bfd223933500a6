#include "gpu_solver/pull_buffer.h"

#include <span>

#include "gpu_solver/support.h"

namespace aspic {
namespace {

layout::Pull block_of(const std::optional<Pull>& pull) {
  layout::Pull block{};
  block.particle = NO_BODY;
  if (!pull) return block;
  const Vec3& anchor = pull->anchor;
  block.anchor = {static_cast<float>(anchor.x), static_cast<float>(anchor.y), static_cast<float>(anchor.z),
                  0.0f};
  block.stiffness = static_cast<float>(pull->stiffness);
  block.damping = static_cast<float>(pull->damping);
  block.particle = pull->particle;
  return block;
}

}  // namespace

Status PullBuffer::build(gl::Context& context) {
  const layout::Pull block = block_of(std::nullopt);
  ASPIC_ASSIGN_OR_RETURN(buffer_, gl::Buffer::of(context, "pull", std::span<const layout::Pull>(&block, 1),
                                                 gl::BufferKind::uniform));
  return {};
}

Status PullBuffer::set(const Model& model, const std::optional<Pull>& pull) {
  std::optional<Pull> taken;
  ASPIC_ASSIGN_OR_RETURN(taken, rounded_pull(model, pull, Precision::single));
  if (taken == pull_) return {};
  pull_ = taken;
  const layout::Pull block = block_of(pull_);
  buffer_.upload_items(std::span<const layout::Pull>(&block, 1));
  return {};
}

}  // namespace aspic
