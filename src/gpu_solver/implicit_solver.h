#pragma once
// Implicit Euler on the device, without a read-back inside a step (shaders/compute/implicit.glsl).
#include <memory>

#include "gpu_solver/gpu_solver.h"

namespace aspic {

struct ForcePathRow;

/// Called by make_gpu_solver for scenes with the integrator implicit-euler; same contract. `path`: one with
/// ForcePathRow::implicit.
Result<std::unique_ptr<GpuSolver>> make_implicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options, const ForcePathRow& path);

/// gpu_bytes() of that solver, but what it shares with the explicit one.
std::uint64_t implicit_bytes(const ModelCounts& counts);

}  // namespace aspic
