#include "gpu_solver/kernels.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "gpu/loop_bound.h"
#include "gpu_solver/layout.h"

namespace aspic {

Result<KernelOptions> kernel_options(gl::Context& context, const Model& model, const GpuOptions& options,
                                     std::uint32_t group_size) {
  KernelOptions kernels{gl::ShaderLibrary(options.shader_directory), {}, {}};
  if (options.arithmetic) {
    kernels.arithmetic = *options.arithmetic;
  } else {
    ASPIC_TRY(kernels.arithmetic, gl::choose_arithmetic(context, kernels.library));
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

}  // namespace aspic
