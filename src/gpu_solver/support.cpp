#include "gpu_solver/support.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/text.h"
#include "gpu/loop_bound.h"

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

Status check_overrun(std::uint32_t overrun) {
  // By KERNEL_… of layout.glsl: the kernel, and what its loop goes over.
  constexpr std::array<std::array<std::string_view, 2>, KERNEL_COUNT> kernels = {
      {{},
       {"gather", "the springs of one particle"},
       {"sum_springs", "the springs of one particle"},
       {"implicit_begin", "the springs of one particle"},
       {"implicit_evaluate", "the springs of one particle"},
       {"implicit_apply", "the springs of one particle"},
       {"ball_find", "blocks of 256 balls"},
       {"ball_gather", "the blocks of particles that one ball touches"},
       {"ball_partials", "the blocks of partners of one body"},
       {"ball_exchange", "the blocks of partners of one ball"},
       {"ball_particles", "the blocks of partners of one particle"}}};
  if (overrun == 0) return {};
  const auto& [name, rounds] = kernels[std::min<std::uint32_t>(overrun, KERNEL_COUNT - 1)];
  return gl::loop_error(name, rounds);
}

Divergence divergence_from(std::uint32_t word, std::uint64_t step, const Model& model) {
  if (word == BAD_RESIDUAL) return {step, 0, false, false, true};
  const std::uint32_t index = word >> 1, particles = model.particle_count();
  const bool ball = index >= particles;
  return {step, ball ? index - particles : index, (word & 1u) != 0, ball};
}

Result<KernelOptions> kernel_options(gl::Context& context, const gl::ShaderLibrary& library,
                                     const Model& model, const GpuOptions& options,
                                     std::uint32_t group_size) {
  KernelOptions kernels;
  if (options.arithmetic) {
    kernels.arithmetic = *options.arithmetic;
  } else {
    ASPIC_ASSIGN_OR_RETURN(kernels.arithmetic, gl::choose_arithmetic(context, library));
  }
  kernels.defines = kernels.arithmetic.defines;
  kernels.defines.push_back({"ASPIC_GROUP_SIZE", std::to_string(group_size)});
  std::uint32_t shapes = 0;
  for (const Terrain& terrain : model.terrain) shapes |= 1u << static_cast<std::uint32_t>(terrain.shape);
  kernels.defines.push_back({"ASPIC_SHAPES", std::to_string(shapes)});
  if (std::ranges::any_of(model.terrain, [](const Terrain& t) { return t.motion.has_value(); }))
    kernels.defines.push_back({"ASPIC_MOTION", "1"});
  kernels.defines.insert(kernels.defines.end(), options.defines.begin(), options.defines.end());
  return kernels;
}

}  // namespace aspic
