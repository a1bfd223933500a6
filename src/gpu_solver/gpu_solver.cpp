#include "gpu_solver/gpu_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/result.h"
#include "gpu/current.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/layout.h"

namespace aspic {
namespace {

/// Without particles there is nothing to solve: balls fly by the formula.
bool solves(Integrator integrator, std::uint64_t particles) {
  return row_of(integrator).solved() && particles > 0;
}

/// Springs that are shared are held already.
Status check_free_memory(gl::Context& context, const Model& model, const GpuOptions& options,
                         const ForcePathRow& path) {
  const std::uint64_t needed = gpu_bytes(model, path.path, context.info().limits.storage_block_bytes),
                      shared =
                          options.share_springs_of ? options.share_springs_of->spring_buffers()->bytes() : 0;
  return context.check_memory(needed - std::min(needed, shared));
}

}  // namespace

Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, const Model& model,
                                                   const GpuOptions& options) {
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  if (context.lost()) return context.lost_error();
  const ForcePathRow& path = row_of(options.force_path, model);
  // Counting takes a while in large scenes, and without a figure to compare with it is for nothing.
  if (context.free_memory()) ASPIC_CHECK(check_free_memory(context, model, options, path));
  if (!solves(model.simulation.integrator, model.particle_count()))
    return make_explicit_solver(context, model, options, path);
  if (path.implicit) return make_implicit_solver(context, model, options, path);
  return Error{ErrorCode::scene_rejected,
               fmt::format("implicit-euler does not take the force path {}: use auto or {}", path.name,
                           implicit_path_words(" or "))};
}

std::uint64_t gpu_bytes(const Model& model, ForcePath path, std::uint64_t block_bytes) {
  const ModelCounts counts = count(model);
  const Integrator integrator = model.simulation.integrator;
  const bool implicit = solves(integrator, counts.particles);
  const ForcePathRow& row =
      row_of(!implicit || works_with(path, integrator) ? path : ForcePath::automatic, model);
  return ball_bytes(counts) + sizeof(layout::Simulation) + sizeof(layout::Pull) +
         (implicit ? implicit_bytes(counts, block_bytes) : explicit_bytes(counts, integrator)) +
         spring_buffer_bytes(model, row.words) + row.spring_bytes * counts.springs();
}

}  // namespace aspic
