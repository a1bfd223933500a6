#pragma once
// What the explicit and the implicit compute solver share: particles to and from the device, the device's
// health.
#include <span>
#include <string>
#include <vector>

#include "gpu/canary.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/layout.h"
#include "model/model.h"

namespace aspic {

/// Assigns the value of a Result to `target`, or returns its error from the enclosing function.
#define ASPIC_ASSIGN_OR_RETURN(target, expression) \
  do {                                             \
    auto made_ = (expression);                     \
    if (!made_) return made_.error();              \
    target = std::move(made_).value();             \
  } while (false)

/// The state as the kernels hold it, rounded to single precision.
/// Error (usage): the state has other numbers of particles and balls than the model.
Result<std::vector<layout::Particle>> to_device(const State& state, const Model& model);

/// The other way, exactly; without balls.
State from_device(std::span<const layout::Particle> particles, std::uint64_t step);

/// Error (no_device): the context was reset or lost. Error (`memory_code`): the driver ran out of memory
/// while at work, so that what it computed is not to be trusted.
Status check_device(gl::Context& context, ErrorCode memory_code = ErrorCode::no_device);

/// Error (no_device): a kernel had a loop of more than MAX_ROUNDS (layout.glsl), which `overrun` of Control
/// or Solve names; 0: none had. The state is not to be trusted then.
Status check_overrun(std::uint32_t overrun);

/// The divergence a kernel's word for it means (layout.glsl, Control and Solve).
Divergence divergence_from(std::uint32_t word, std::uint64_t step, const Model& model);

/// Asks the canary unless the options know already, and adds the group size and the model's terrain shapes to
/// its defines.
struct KernelOptions {
  gl::Arithmetic arithmetic;
  std::vector<gl::Define> defines;
};
Result<KernelOptions> kernel_options(gl::Context& context, const gl::ShaderLibrary& library,
                                     const Model& model, const GpuOptions& options, std::uint32_t group_size);

}  // namespace aspic
