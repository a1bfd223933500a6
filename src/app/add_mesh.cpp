#include "app/add_mesh.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <utility>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "aspic/model.h"
#include "base/printable.h"
#include "model/integrator.h"
#include "scene/import_mesh.h"

namespace aspic::app {
namespace {

bool is_stable(const Model& model, const StabilityLimit& limit) {
  return !exceeds(model.simulation.timestep, limit);
}

/// A time step for a scene with one body more, and a sentence about it; empty: it keeps its own.
std::string keep_stable(const Scene& before, Scene& after) {
  if (row_of(before.model.simulation.integrator).kind() == MethodKind::newton) return "";
  const auto without = build_model(before.model), with = build_model(after.model);
  if (!without || !with) return "";
  const Integrator integrator = with->simulation.integrator;
  const StabilityLimit limit = stability_limit(*with, integrator, StabilityEffort::quick);
  if (is_stable(*with, limit) ||
      !is_stable(*without, stability_limit(*without, integrator, StabilityEffort::quick)))
    return "";
  double& timestep = after.model.simulation.timestep;
  const double usual = usual_timestep(limit, timestep);
  if (!(usual < timestep)) return "";
  const double own = std::exchange(timestep, usual);
  return fmt::format(" The time step is now {:.4g} s: at {:.4g} s the body would be unstable.", usual, own);
}

}  // namespace

void add_mesh(SceneControl& scene, Messages& messages, const std::string& path) {
  Scene changed = scene.scene();
  const auto notes = aspic::add_mesh(changed, path);
  if (!notes) return messages.error(notes.error());
  const std::string step = keep_stable(scene.scene(), changed);
  const std::size_t bodies = scene.scene().model.voxels.size();
  scene.apply(std::move(changed), "add mesh");
  if (scene.scene().model.voxels.size() == bodies) return;  // refused, for want of memory
  std::string text = printable_line(std::filesystem::path(path).filename().string()) + " is now a body";
  for (const std::string& note : *notes)
    text += fmt::format("{} {}", &note == &notes->front() ? ":" : ";", note);
  scene.tell(text + "." + step);
}

}  // namespace aspic::app
