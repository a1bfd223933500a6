#pragma once
// Explicit methods on the device: every stage one or two dispatches, no read-back inside a step.
#include <memory>

#include "gpu_solver/gpu_solver.h"

namespace aspic {

struct ForcePathRow;

/// Called by make_gpu_solver for scenes with an explicit method, or without particles; same contract.
Result<std::unique_ptr<GpuSolver>> make_explicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options, const ForcePathRow& path);

/// gpu_bytes() of that solver, but what it shares with the implicit one.
std::uint64_t explicit_bytes(const ModelCounts& counts, Integrator integrator);

}  // namespace aspic
