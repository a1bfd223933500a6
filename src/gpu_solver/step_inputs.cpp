#include "gpu_solver/step_inputs.h"

#include <algorithm>
#include <cstddef>

#include "device/particles.h"
#include "model/pull.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// PullBlock of shaders/compute/terms/pulls.glsl.
struct PullTable {
  std::uint32_t count = 0, padding0 = 0, padding1 = 0, padding2 = 0;
  layout::Pull pulls[MAX_PULLS] = {};
};
static_assert(sizeof(PullTable) == pull_table_bytes && sizeof(PullTable) <= 16384 && MAX_PULLS == most_pulls);

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
  const PullTable none;
  ASPIC_TRY(buffer_, gl::Buffer::of(context, "pulls", std::span(&none, 1), gl::BufferKind::uniform));
  return {};
}

void PullBuffer::set(const Model& model, std::span<const Pull> pulls) {
  PullTable table;
  for (const Pull& pull : pulls) {
    layout::Pull& row = table.pulls[table.count++];
    row.anchor = rounded(pull.anchor, 0.0);
    row.stiffness = static_cast<float>(pull.stiffness);
    row.damping = static_cast<float>(pull.damping);
    // Balls count on after the particles.
    row.particle = pull.particle + (pull.ball ? model.particle_count() : 0u);
  }
  buffer_.upload(std::as_bytes(std::span(&table, 1))
                     .first(offsetof(PullTable, pulls) + pulls.size() * sizeof(layout::Pull)));
}

Status PoseBuffer::build(gl::Context& context, const Model& model) {
  set_model(model);
  ASPIC_TRY(buffer_, gl::Buffer::create(context, "terrain poses", !moving_.empty() ? sizeof(PoseTable) : 0,
                                        gl::BufferKind::uniform));
  return {};
}

void PoseBuffer::set_model(const Model& model) {
  timestep_ = model.simulation.timestep;
  moving_.clear();
  for (const Terrain& terrain : model.terrain)
    if (terrain.motion) moving_.push_back(*terrain.motion);
  rows_ = 0;
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
