#include "gpu_solver/step_inputs.h"

#include <algorithm>
#include <span>

#include "device/particles.h"
#include "model/pull.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// Balls count on after the particles.
layout::Pull block_of(const std::optional<Pull>& pull, std::uint32_t particles) {
  layout::Pull block{};
  block.particle = NO_BODY;
  if (!pull) return block;
  block.anchor = rounded(pull->anchor, 0.0);
  block.stiffness = static_cast<float>(pull->stiffness);
  block.damping = static_cast<float>(pull->damping);
  block.particle = pull->particle + (pull->ball ? particles : 0u);
  return block;
}

/// PoseBlock of shaders/compute/motion.glsl.
struct PoseTable {
  std::uint32_t first = 0, count = 0, padding0 = 0, padding1 = 0;
  layout::Pose poses[MAX_POSES] = {};
};
static_assert(sizeof(PoseTable) == 16 + 32 * MAX_POSES && sizeof(PoseTable) <= 16384);
// Both ends of at least one step find room.
static_assert(MAX_POSES >= 2 * MAX_TERRAINS);

}  // namespace

Status PullBuffer::build(gl::Context& context) {
  const layout::Pull block = block_of(std::nullopt, 0);
  ASPIC_TRY(buffer_, gl::Buffer::of(context, "pull", std::span(&block, 1), gl::BufferKind::uniform));
  return {};
}

Result<bool> PullBuffer::changes(const Model& model, const std::optional<Pull>& pull) const {
  ASPIC_TRY(const std::optional<Pull> taken, rounded_pull(model, pull, Precision::single));
  return taken != pull_;
}

Status PullBuffer::set(const Model& model, const std::optional<Pull>& pull) {
  ASPIC_TRY(const std::optional<Pull> taken, rounded_pull(model, pull, Precision::single));
  if (taken == pull_) return {};
  pull_ = taken;
  const layout::Pull block = block_of(pull_, model.particle_count());
  buffer_.upload_items(std::span(&block, 1));
  return {};
}

Status PoseBuffer::build(gl::Context& context, const Model& model) {
  timestep_ = model.simulation.timestep;
  for (const Terrain& terrain : model.terrain)
    if (terrain.motion) moving_.push_back(*terrain.motion);
  ASPIC_TRY(buffer_, gl::Buffer::create(context, "terrain poses", !moving_.empty() ? sizeof(PoseTable) : 0,
                                        gl::BufferKind::uniform));
  return {};
}

void PoseBuffer::set_base_step(std::uint64_t base_step) {
  base_step_ = base_step;
  rows_ = 0;
}

std::uint32_t PoseBuffer::cover(std::uint32_t step, std::uint32_t wanted) {
  if (moving_.empty()) return wanted;
  const auto count = static_cast<std::uint32_t>(moving_.size());
  // A step needs its own row and the next.
  const auto covered = [&] {
    return step < first_ || step - first_ + 1 >= rows_ ? 0u : rows_ - 1 - (step - first_);
  };
  const std::uint32_t room = MAX_POSES / count;
  if (covered() < std::min(wanted, room - 1)) {
    PoseTable table;
    first_ = table.first = step;
    table.count = count;
    rows_ = room;
    for (std::uint32_t row = 0; row < rows_; ++row) {
      for (std::uint32_t m = 0; m < count; ++m) {
        const Pose pose = pose_at(moving_[m], timestep_, base_step_ + step + row);
        table.poses[row * count + m] = {rounded(pose.offset, 0.0), rounded(pose.velocity, 0.0)};
      }
    }
    buffer_.upload_items(std::span(&table, 1));
  }
  return std::min(wanted, covered());
}

}  // namespace aspic
