// The section of the picture: what is drawn, from where, and how large the words are.
#include <imgui.h>

#include "app/app.h"
#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

/// A camera value, which lives in the window and not in the scene until it is saved.
void edit_camera(App& app, std::string_view path, std::string_view label) {
  Scene scene;
  scene.view.camera = app.camera().goal();
  const Parameter& p = *find_parameter(path);
  const auto change = parameter_widget(app.gui(), p, scene, 0, {label});
  if (!change || !change->value || check_value(p, *change->value)) return;
  p.set(scene, 0, *change->value);
  if (length(scene.view.camera.position - scene.view.camera.target) > 1e-3)
    app.camera().jump_to(scene.view.camera);
}

struct Preset {
  const char *name, *label, *help;
  Vec3 from;
};
const Preset presets[] = {
    {"camera/front", "Front", "Looks along −z, at the target from the front; the distance stays.", {0, 0, 1}},
    {"camera/side", "Side", "Looks along −x, at the target from the right; the distance stays.", {1, 0, 0}},
    {"camera/top", "Top", "Looks down on the target; the distance stays.", {0, 1, 0}},
    {"camera/isometric",
     "Isometric",
     "Looks at the target along (−1, −1, −1); the distance stays.",
     {1, 1, 1}},
};

void camera_buttons(App& app) {
  Gui& gui = app.gui();
  const float half = share_of_line(2);
  for (int i = 0; i < 4; ++i) {
    if (i % 2 == 1) ImGui::SameLine();
    const Preset& p = presets[i];
    if (button(gui, p.name, p.label, p.help, "", true, half)) app.camera().look_from(p.from);
  }
  if (button(gui, "camera/home", "Scene's", "To the scene's own camera.", "reset the camera", true, half))
    app.camera().reset();
  ImGui::SameLine();
  if (button(gui, "camera/frame", "Frame bodies",
             "Comes near or backs off until all bodies are in the picture.", "frame the bodies", true, half))
    app.frame_bodies();
  if (button(gui, "camera/copy", "Copy", "The camera as text, a line for [view] of a scene file.",
             "copy the camera as text", true, half))
    app.copy_camera();
  ImGui::SameLine();
  if (button(gui, "camera/paste", "Paste", "Takes a camera from the clipboard.", "paste a camera", true,
             half))
    app.paste_camera();
}

/// Taken on when the mouse lets go: the slider would run away from under it.
void text_size(App& app) {
  Layout& layout = app.layout();
  label_column("Text size");
  const double low = Layout::smallest_text, high = Layout::largest_text;
  ImGui::SliderScalar("##text", ImGuiDataType_Double, &layout.text_size, &low, &high, "×%.2f",
                      ImGuiSliderFlags_AlwaysClamp);
  app.gui().mark("layout/text-size");
  const bool done = ImGui::IsItemDeactivated();
  tooltip(
      "Size of text and panels, a factor from 0.75 to 2.5 on that of the display: larger for a lecture hall. "
      "Remembered when the window is closed.\nDrag to change, Ctrl+click to type.");
  if (done) app.gui().set_text_size(layout.text_size);
}

}  // namespace

void view_section(App& app) {
  edit(app, "view.draw");
  edit(app, "view.colour", 0, {"Colour by"});
  ImGui::Checkbox("shadows", &app.shadows());
  app.gui().mark("view/shadows");
  tooltip(
      "Shadows that bodies and balls cast on terrain. Without them pictures take less time. Only of this "
      "window: files and films of aspic run have them.");
  camera_buttons(app);
  edit_camera(app, "view.camera.position", "Camera");
  edit_camera(app, "view.camera.target", "Looks at");
  edit_camera(app, "view.camera.fov", "Field of view");
  text_size(app);
  if (button(app.gui(), "layout/reset", "Reset layout",
             "Panels, their widths and the size of text as at the first time. Scene and camera stay.", "",
             true, -1.0f)) {
    app.layout() = Layout();
    app.gui().set_text_size(1.0);
  }
}

}  // namespace aspic::app
