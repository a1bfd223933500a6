#pragma once
// The springs of a model on the device. Nothing writes them once they are made, so solvers and pictures of
// one context may share them.
#include <cstdint>
#include <memory>

#include "gpu/buffer.h"
#include "model/incident_springs.h"

namespace aspic {

struct SpringBuffers {
  const gl::Context* context = nullptr;
  IncidentWords kind = IncidentWords::neighbours;  ///< what the incident words mean
  gl::Buffer incident_start;                       ///< BINDING_INCIDENT_START
  gl::Buffer incident;                             ///< BINDING_INCIDENT
  gl::Buffer springs;  ///< BINDING_SPRINGS: packed_springs(), with words that name springs alone

  std::uint64_t bytes() const { return incident_start.bytes() + incident.bytes() + springs.bytes(); }
};

/// Errors: as incident_springs and Buffer::create.
Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind);

/// Whether both models' springs are the same words on the device; constants of their classes do not matter.
bool same_springs(const Model& a, const Model& b);

}  // namespace aspic
