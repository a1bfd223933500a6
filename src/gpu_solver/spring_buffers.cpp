#include "gpu_solver/spring_buffers.h"

#include <algorithm>
#include <utility>

#include "gpu_solver/simulation_block.h"
#include "gpu_solver/support.h"
#include "gpu_solver/topology.h"

namespace aspic {
namespace {

/// Whether both models' springs are the same words on the device; constants of their classes do not matter.
bool same_springs(const Model& a, const Model& b) {
  return a.particle_count() == b.particle_count() && class_bits(a) == class_bits(b) &&
         std::equal(a.springs.begin(), a.springs.end(), b.springs.begin(), b.springs.end());
}

}  // namespace

Result<std::shared_ptr<const SpringBuffers>> spring_buffers(gl::Context& context, const Model& model,
                                                            ForcePath path, const GpuSolver* like) {
  if (like) {
    const auto& theirs = like->spring_buffers();
    if (theirs->context == &context && theirs->path == path && same_springs(like->model(), model))
      return theirs;
  }
  auto made = std::make_shared<SpringBuffers>();
  made->context = &context;
  made->path = path;
  gl::BufferFiller fill(context);
  IncidentSprings rows;
  if (path == ForcePath::gather) {
    ASPIC_ASSIGN_OR_RETURN(rows, neighbours_of(model));
  } else {
    std::vector<layout::uvec2> springs;
    ASPIC_ASSIGN_OR_RETURN(springs, packed_springs(model));
    fill(made->springs, "springs", springs);
    rows = springs_of(model);
  }
  fill(made->incident_start, "incident spring rows", rows.start);
  fill(made->incident, "incident springs", rows.words);
  if (!fill.status()) return fill.status().error();
  return std::shared_ptr<const SpringBuffers>(std::move(made));
}

}  // namespace aspic
