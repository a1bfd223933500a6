// The rows of the section View that set the scale of a color that shows a number.
#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

/// An end of a fixed scale. Ticked, it starts as what the image has.
void edit_end(Gui& gui, SceneControl& scene, std::string_view path, double shown) {
  const Parameter& p = *find_parameter(path);
  const bool absent = !p.get(scene.scene(), 0);
  const auto change = parameter_widget(gui, p, scene.scene(), 0);
  if (!change) return;
  if (change->value)
    scene.set_value(p, 0, absent ? Value(shown) : *change->value, change->gesture);
  else
    scene.change(key_text(p), [&](Scene& changed) { p.clear(changed, 0); });
}

}  // namespace

void scale_rows(Gui& gui, SceneControl& scene, const QuantityRange& shown) {
  const ViewSettings& view = scene.scene().view;
  if (!has_scale(view.color)) return;
  edit(gui, scene, "view.scale.map", 0, {"Colors"});
  edit(gui, scene, "view.scale.range", 0, {"Range"});
  if (view.scale.range == ScaleRange::fixed) {
    edit_end(gui, scene, "view.scale.from", shown[0]);
    edit_end(gui, scene, "view.scale.to", shown[1]);
  } else if (button(gui, "scale/keep", "Keep this range",
                    "Fixes the ends of the scale at their present values.", true, -1.0f)) {
    scene.change("view.scale", [&](Scene& changed) {
      changed.view.scale.range = ScaleRange::fixed;
      changed.view.scale.from = shown[0];
      changed.view.scale.to = shown[1];
    });
  }
}

}  // namespace aspic::app
