#pragma once
// What the host tells the kernels between steps, in small uniform blocks: pulls, and where terrain is.
#include <cstdint>
#include <span>
#include <vector>

#include "aspic/inputs.h"
#include "gpu/pass.h"
#include "gpu_solver/layout.h"
#include "model/inputs.h"
#include "model/model.h"

namespace aspic {

/// The table of pulls with its head.
inline constexpr std::uint64_t pull_table_bytes = 16 + sizeof(layout::Pull) * MAX_PULLS;

/// The pulls, which every force kernel reads.
class PullBuffer {
 public:
  /// Nothing is pulled. Errors as Buffer::create.
  Status build(gl::Context& context);
  /// Pulls that rounded_inputs() returned for the model. An upload of 32 bytes for each and 16, queued after
  /// the steps before.
  void set(const Model& model, std::span<const Pull> pulls);
  gl::Binding binding() const { return {BINDING_PULLS, &buffer_, gl::BufferKind::uniform}; }

 private:
  gl::Buffer buffer_;
};

/// Moving terrain: the poses of the next steps, made here in double precision and rounded once, so that many
/// steps can be queued at a time.
class PoseBuffer {
 public:
  /// For the terrains of the model that move; a token buffer if none does. Errors as Buffer::create.
  Status build(gl::Context& context, const Model& model);
  gl::Binding binding() const { return {BINDING_POSES, &buffer_, gl::BufferKind::uniform}; }

  /// Another model, with as many terrains that move.
  void set_model(const Model& model);
  /// The kernels count steps from the state of this number.
  void set_base_step(std::uint64_t base_step);

  /// Sees to it that the device has the poses of `wanted` ≥ 1 steps from `step` on, or of as many as there is
  /// room for, and returns how many it has. Writes a table that reaches further, after the steps queued so
  /// far.
  std::uint32_t cover(std::uint32_t step, std::uint32_t wanted);

 private:
  std::vector<TerrainMotion> moving_;
  double timestep_ = 0.0;
  std::uint64_t base_step_ = 0;
  std::uint32_t first_ = 0, rows_ = 0;  ///< steps in the table; 0 rows: none yet
  gl::Buffer buffer_;
};

}  // namespace aspic
