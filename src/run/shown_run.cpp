#include "run/shown_run.h"

#include "render/camera.h"
#include "render/overlay_text.h"
#include "run/arrows.h"

namespace aspic {

bool needs_copy(const Scene& scene, const Following& following) {
  return following.any() || scene.view.arrows.any();
}

ShownRun shown_run(const Scene& scene, const Following& following, const Solver& solver, std::uint64_t step,
                   const State& copy, const PictureWish& wish) {
  const ViewSettings& view = scene.view;
  const Model& model = solver.model();
  ShownRun shown;
  shown.camera = fitted(moved(view.camera, following.offset(model, copy)), wish.size.width, wish.size.height);
  shown.legend = wish.text;
  shown.channels = solver.inputs().channels;
  if (view.arrows.any()) shown.arrows = arrows_of(model, copy, view.arrows, solver.inputs());
  if (wish.text) shown.text = overlay_lines(scene, static_cast<double>(step) * model.simulation.timestep);
  return shown;
}

}  // namespace aspic
