#include "gpu_solver/support.h"

#include <fmt/format.h>

#include "base/text.h"

namespace aspic {

Result<std::vector<layout::Particle>> to_device(const State& state, const Model& model) {
  if (const Status fits = check_sizes(model, state); !fits) return fits.error();
  std::vector<layout::Particle> particles(state.position.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 &x = state.position[i], &v = state.velocity[i];
    particles[i].position = {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z),
                             static_cast<float>(model.inverse_mass[i])};
    particles[i].velocity = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
                             static_cast<float>(model.mass[i])};
  }
  return particles;
}

State from_device(std::span<const layout::Particle> particles, std::uint64_t step) {
  State state;
  state.precision = Precision::single;
  state.step = step;
  state.position.reserve(particles.size());
  state.velocity.reserve(particles.size());
  for (const layout::Particle& p : particles) {
    state.position.push_back({p.position.x, p.position.y, p.position.z});
    state.velocity.push_back({p.velocity.x, p.velocity.y, p.velocity.z});
  }
  return state;
}

Status check_device(gl::Context& context, ErrorCode memory_code) {
  if (context.lost()) return context.lost_error();
  if (!context.ran_out_of_memory()) return {};
  return Error{
      memory_code,
      fmt::format("The device {} ran out of memory at work, with {} ({} bytes) held in buffers. Make the "
                  "scene smaller, close other programs that use the device, or choose --backend reference.",
                  context.info().renderer, human_bytes(context.bytes_held()), context.bytes_held())};
}

Divergence divergence_from(std::uint32_t word, std::uint64_t step, const Model& model) {
  const std::uint32_t index = word >> 1, particles = model.particle_count();
  const bool ball = index >= particles;
  return {step, ball ? index - particles : index, (word & 1u) != 0, ball};
}

Result<KernelOptions> kernel_options(gl::Context& context, const gl::ShaderLibrary& library,
                                     const GpuOptions& options, std::uint32_t group_size) {
  KernelOptions kernels;
  if (options.arithmetic) {
    kernels.arithmetic = *options.arithmetic;
  } else {
    ASPIC_ASSIGN_OR_RETURN(kernels.arithmetic, gl::choose_arithmetic(context, library));
  }
  kernels.defines = kernels.arithmetic.defines;
  kernels.defines.push_back({"ASPIC_GROUP_SIZE", std::to_string(group_size)});
  return kernels;
}

}  // namespace aspic
