#include "render/run_view.h"

#include "render/camera.h"
#include "render/overlay_text.h"
#include "render/state_arrows.h"

namespace aspic {

bool needs_copy(const Scene& scene, const Following& following) {
  return following.any() || scene.view.arrows.any();
}

RunView run_view(const Scene& scene, const Following& following, const Solver& solver, std::uint64_t step,
                 const State& copy, const FrameRequest& request) {
  const ViewSettings& view = scene.view;
  const Model& model = solver.model();
  RunView shown;
  shown.camera =
      fitted(moved(view.camera, following.offset(model, copy)), request.size.width, request.size.height);
  shown.legend = request.text;
  shown.channels = solver.inputs().channels;
  if (view.arrows.any()) shown.arrows = arrows_of(model, copy, view.arrows, solver.inputs());
  if (request.text) shown.text = overlay_lines(scene, static_cast<double>(step) * model.simulation.timestep);
  return shown;
}

}  // namespace aspic
