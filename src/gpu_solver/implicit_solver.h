#pragma once
// Implicit Euler on the device, without a read-back inside a step (shaders/compute/implicit.glsl).
#include <memory>

#include "gpu_solver/gpu_solver.h"

namespace aspic {

/// Called by make_gpu_solver for scenes with the integrator implicit-euler; same contract.
Result<std::unique_ptr<GpuSolver>> make_implicit_solver(gl::Context& context, const Model& model,
                                                        const GpuOptions& options);

}  // namespace aspic
