#pragma once
// The springs of a model on the device. Nothing writes them once they are made, so solvers of one context may
// share them: a solver rebuilt for another stiffness needs no new ones.
#include <cstdint>
#include <memory>

#include "gpu/buffer.h"
#include "gpu_solver/gpu_solver.h"
#include "model/model.h"

namespace aspic {

struct SpringBuffers {
  const gl::Context* context = nullptr;
  ForcePath path = ForcePath::gather;  ///< gather or per_spring: what the incident words mean
  gl::Buffer incident_start;           ///< BINDING_INCIDENT_START
  gl::Buffer incident;                 ///< BINDING_INCIDENT
  gl::Buffer springs;                  ///< BINDING_SPRINGS, per_spring alone

  std::uint64_t bytes() const { return incident_start.bytes() + incident.bytes() + springs.bytes(); }
};

/// Those of `like` where they fit, else new ones. `like` may be null.
/// Errors: as neighbours_of and Buffer::create.
Result<std::shared_ptr<const SpringBuffers>> spring_buffers(gl::Context& context, const Model& model,
                                                            ForcePath path, const GpuSolver* like);

}  // namespace aspic
