#include "gpu_solver/gpu_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu_solver/ball_passes.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/layout.h"

namespace aspic {
namespace {

/// Without particles there is nothing to solve: balls fly by the formula.
bool solves(Integrator integrator, std::uint64_t particles) {
  return row_of(integrator).solved() && particles > 0;
}

}  // namespace

Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, const Model& model,
                                                   const GpuOptions& options) {
  ASPIC_CHECK(check_built(options.force_path));
  if (context.lost()) return context.lost_error();
  const ForcePathRow& path = row_of(options.force_path);
  const std::uint64_t shared =
                          options.share_springs_of ? options.share_springs_of->spring_buffers()->bytes() : 0,
                      needed = gpu_bytes(count(model), model.simulation.integrator, path.path);
  ASPIC_CHECK(context.check_memory(needed - std::min(needed, shared)));
  if (!solves(model.simulation.integrator, model.particle_count()))
    return make_explicit_solver(context, model, options, path);
  if (path.implicit) return make_implicit_solver(context, model, options, path);
  return Error{ErrorCode::scene_rejected,
               fmt::format("implicit-euler does not take the force path {}: use auto or {}", path.name,
                           built_path_words(" or ", true))};
}

std::uint64_t gpu_bytes(const ModelCounts& counts, Integrator integrator, ForcePath path) {
  const bool implicit = solves(integrator, counts.particles);
  const ForcePathRow& row = row_of(works_with(path, integrator) || !implicit ? path : ForcePath::automatic);
  return ball_bytes(counts) + sizeof(layout::Simulation) + sizeof(layout::Pull) +
         (implicit ? implicit_bytes(counts) : explicit_bytes(counts, integrator)) +
         4 * (counts.particles + 1) + row.spring_bytes * counts.springs();
}

}  // namespace aspic
