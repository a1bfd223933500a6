#include "gpu_solver/gpu_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/result.h"
#include "gpu/current.h"
#include "gpu_solver/ball_face_passes.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/device_solver.h"
#include "gpu_solver/layout.h"
#include "gpu_solver/lengths.h"

namespace aspic {
namespace {

/// Springs that are shared are held already.
Status check_free_memory(gl::Context& context, const Model& model, const GpuOptions& options,
                         const ForcePathRow& path) {
  const std::uint64_t needed = gpu_bytes(model, path.path),
                      shared =
                          options.share_springs_of ? options.share_springs_of->spring_buffers()->bytes() : 0;
  return context.check_memory(needed - std::min(needed, shared));
}

}  // namespace

const DeviceMethod& device_method(Integrator integrator, std::uint64_t particles) {
  if (particles == 0) return staged_method;
  switch (row_of(integrator).kind()) {
    case MethodKind::staged:
      return staged_method;
    case MethodKind::newton:
      return newton_method;
  }
  assert(false);
  return staged_method;
}

IncidentWords incident_words(const Model& model, const ForcePathRow& path) {
  if (path.words != IncidentWords::beside_cells) return path.words;
  if (device_method(model.simulation.integrator, model.particle_count()).cells && has_cells(model))
    return IncidentWords::beside_cells;
  return has_lattices(model) ? IncidentWords::beside_lattices : IncidentWords::neighbors;
}

Result<std::unique_ptr<GpuSolver>> make_gpu_solver(gl::Context& context, SharedModel shared_model,
                                                   const GpuOptions& options) {
  const Model& model = *shared_model;
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  if (context.lost()) return context.lost_error();
  const ForcePathRow& path = row_of(options.force_path, model);
  // Counting takes a while in large scenes, and without a figure to compare with it is for nothing.
  if (context.free_memory()) ASPIC_CHECK(check_free_memory(context, model, options, path));
  const Integrator integrator = model.simulation.integrator;
  const DeviceMethod& method = device_method(integrator, model.particle_count());
  if (method.takes(path)) return method.make(context, std::move(shared_model), options, path);
  return Error{ErrorCode::scene_rejected,
               fmt::format("{} does not support the force path {}: use auto or {}", name_of(integrator),
                           path.name, force_path_words(integrator, " or "))};
}

std::uint64_t gpu_bytes(const Model& model, ForcePath path) {
  const ModelCounts counts = count(model);
  const Integrator integrator = model.simulation.integrator;
  const DeviceMethod& method = device_method(integrator, counts.particles);
  const ForcePathRow& wanted = row_of(path, model);
  const ForcePathRow& row = method.takes(wanted) ? wanted : row_of(ForcePath::automatic, model);
  return ball_bytes(counts) + ball_face_bytes(model) + sizeof(layout::Simulation) + pull_table_bytes +
         method.bytes(counts, integrator) + spring_buffer_bytes(model, incident_words(model, row)) +
         row.spring_bytes * counts.springs() + length_bytes(model);
}

}  // namespace aspic
