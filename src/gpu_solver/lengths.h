#pragma once
// Rest lengths that follow signals: those of the next steps, made here in double precision and rounded once,
// so that many steps can be queued at a time (shaders/compute/spring_classes.glsl).
#include <cstdint>
#include <optional>
#include <vector>

#include "device/device_state.h"
#include "gpu/pass.h"
#include "model/actuation.h"
#include "model/model.h"

namespace aspic {

/// Bytes that it takes for a model at most.
std::uint64_t length_bytes(const Model& model);

class LengthBuffer {
 public:
  /// Of a model with actuators, whose springs are these; of any other nothing is made. Errors as
  /// Buffer::create.
  Status build(gl::Context& context, const Model& model, const SpringBuffers& springs);
  /// Whether there are any.
  bool any() const { return buffer_.id() != 0; }
  /// For BINDING_INCIDENT_START, in the place of the springs' own; any() must hold.
  const gl::Buffer& buffer() const { return buffer_; }

  /// Another model with the same springs and drives.
  void set_model(const Model& model);
  /// The kernels count steps from the state of this number.
  void set_base_step(std::uint64_t base_step);
  /// Inputs::channels of the steps to come.
  void set_channels(const std::vector<double>& channels);

  /// Sees to it that the device has the rest lengths of `wanted` ≥ 1 steps from `step` on, or of as many as
  /// there is room for, and returns how many it has. Writes a table that reaches further, after the steps
  /// queued so far.
  std::uint32_t cover(std::uint32_t step, std::uint32_t wanted);

 private:
  const Model* model_ = nullptr;
  std::optional<RestLengths> lengths_;
  std::vector<double> shares_;  // of a step, by stage
  std::vector<double> channels_;
  std::uint64_t base_step_ = 0, constants_at_ = 0, rows_at_ = 0;  // words
  std::uint32_t first_ = 0, steps_ = 0, room_ = 0;                // steps in the table, and at most
  gl::Buffer buffer_;
};

}  // namespace aspic
