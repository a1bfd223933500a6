#pragma once
// The kernels of implicit Euler (shaders/compute/implicit.glsl), and the block by which they know what to do.
#include <array>
#include <cstdint>

#include "gpu_solver/kernels.h"
#include "gpu_solver/layout.h"

namespace aspic::implicit {

enum Kernel : std::size_t { begin, evaluate, apply, update, direction, finish, kernel_count };
inline constexpr std::array<KernelRow, kernel_count> implicit_kernels = {
    {{"compute/implicit_begin.comp", "start of the step"},
     {"compute/implicit_evaluate.comp", "residual"},
     {"compute/implicit_apply.comp", "Jacobian times direction"},
     {"compute/implicit_update.comp", "solution update"},
     {"compute/implicit_direction.comp", "search direction"},
     {"compute/implicit_finish.comp", "end of the step, contact"}}};

/// Of the Solve block and the reductions' partial results.
inline std::uint64_t solve_bytes(std::uint64_t particles) {
  const std::uint64_t blocks = (particles + REDUCTION_BLOCK - 1) / REDUCTION_BLOCK;
  return sizeof(layout::Solve) + blocks * sizeof(layout::vec4);
}

}  // namespace aspic::implicit
