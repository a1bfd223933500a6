#pragma once
// How a solver's kernels are compiled, the constants they read, and what they say of loops they had to cut
// short.
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "gpu/canary.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/layout.h"

namespace aspic {

struct KernelOptions {
  gl::ShaderLibrary library;
  gl::Arithmetic arithmetic;
  std::vector<gl::Define> defines;  ///< of the arithmetic, the group size, the model and GpuOptions
  gl::ProgramBatch* batch;          ///< that the solver's programs are begun in

  /// Begins to compile a kernel. Errors: io.
  Result<gl::SharedProgram> start(std::string_view path) const {
    return batch->start(library, {.compute = path}, defines);
  }
};

/// A kernel, and the title of its passes in profiles.
struct KernelRow {
  const char *path, *title;
};
/// Their titles.
std::vector<std::string> titles_of(std::span<const KernelRow> rows);

/// Asks the canary unless the options know the arithmetic already. The kernels leave out the terrain shapes,
/// and the motion, that the model does not have. Errors: those of choose_arithmetic;
/// no_device: the device takes no groups of this size.
Result<KernelOptions> kernel_options(gl::Context& context, const Model& model, const GpuOptions& options,
                                     std::uint32_t group_size, gl::ProgramBatch& batch);

/// The error (no_device) of a device that drops what it is given: of `count` dispatches some were not carried
/// out.
Error idle_device(const gl::Context& context, const Model& model, std::uint64_t count);

/// Error (no_device): a kernel had a loop of more than MAX_ROUNDS (shaders/shared/layout.glsl), which
/// `overrun` of Control or Solve names; 0: none had. The state is not to be trusted then.
Status check_overrun(std::uint32_t overrun);

/// Fills the block. Errors (scene_rejected): more spring classes or
/// terrains than the block holds.
Result<layout::Simulation> simulation_block(const Model& model);

}  // namespace aspic
