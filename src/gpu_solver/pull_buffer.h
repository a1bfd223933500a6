#pragma once
// The pull on the device: one small uniform block that every force kernel reads.
#include <optional>

#include "gpu/pass.h"
#include "gpu_solver/layout.h"
#include "model/pull.h"

namespace aspic {

class PullBuffer {
 public:
  /// Nobody is pulled. Errors as Buffer::create.
  Status build(gl::Context& context);
  /// See Solver::set_pull. An upload of 32 bytes, queued after the steps before; nothing if nothing changed.
  Status set(const Model& model, const std::optional<Pull>& pull);
  gl::Binding binding() const { return {BINDING_PULL, &buffer_, gl::BufferKind::uniform}; }

 private:
  gl::Buffer buffer_;
  std::optional<Pull> pull_;
};

}  // namespace aspic
