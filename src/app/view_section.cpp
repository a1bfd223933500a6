// The section of the picture: what is drawn, from where, and how large the words are.
#include <imgui.h>

#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
namespace {

/// A camera value, which lives in the window and not in the scene until it is saved.
void edit_camera(Gui& gui, CameraControl& camera, std::string_view path, std::string_view label) {
  Scene scene;
  scene.view.camera = camera.goal();
  const Parameter& p = *find_parameter(path);
  const auto change = parameter_widget(gui, p, scene, 0, {label});
  if (!change || !change->value || check_value(p, *change->value)) return;
  p.set(scene, 0, *change->value);
  if (length(scene.view.camera.position - scene.view.camera.target) > 1e-3) camera.jump_to(scene.view.camera);
}

struct Preset {
  const char *name, *label;
  Vec3 from;
  const char* help;
};
const Preset presets[] = {
    {"camera/front",
     "Front",
     {0, 0, 1},
     "Looks along −z, at the target from the front, at the same distance."},
    {"camera/side", "Side", {1, 0, 0}, "Looks along −x, at the target from the right, at the same distance."},
    {"camera/top", "Top", {0, 1, 0}, "Looks down on the target, at the same distance."},
    {"camera/isometric",
     "Isometric",
     {1, 1, 1},
     "Looks at the target along (−1, −1, −1), at the same distance."},
};

void camera_buttons(Gui& gui, CameraControl& camera) {
  const float half = share_of_line(2);
  for (int i = 0; i < 4; ++i) {
    if (i % 2 == 1) ImGui::SameLine();
    const Preset& p = presets[i];
    if (button(gui, p.name, p.label, p.help, true, half)) camera.look_from(p.from);
  }
  command_button(gui, "camera/home", "Scene camera", "Returns to the scene's own camera.", "reset the camera",
                 true, half);
  ImGui::SameLine();
  command_button(gui, "camera/frame", "Frame bodies", "Moves the camera until all bodies are in the picture.",
                 "frame the bodies", true, half);
  command_button(gui, "camera/copy", "Copy", "Copies the camera as text, a line for [view] of a scene file.",
                 "copy the camera as text", true, half);
  ImGui::SameLine();
  command_button(gui, "camera/paste", "Paste", "Sets the camera from the clipboard.", "paste a camera", true,
                 half);
}

struct CutPreset {
  const char *name, *label, *help;
  Vec3 normal;
};
const CutPreset cut_presets[] = {
    {"cut/x", "X", "Cuts across the x axis: the side of larger x is taken away.", {1, 0, 0}},
    {"cut/y", "Y", "Cuts across the y axis: the upper side is taken away.", {0, 1, 0}},
    {"cut/z", "Z", "Cuts across the z axis: the side of larger z is taken away.", {0, 0, 1}},
};

void cut_widgets(Gui& gui, SceneControl& scene, const CameraSettings& camera) {
  edit(gui, scene, "view.cut.inside", 0, {"Cut"});
  if (!scene.scene().view.cut.on()) return;
  const auto turn = [&](const Vec3& normal) {
    scene.change("view.cut.normal", [&](Scene& changed) { changed.view.cut.normal = normal; });
  };
  const float quarter = share_of_line(4);
  for (const CutPreset& p : cut_presets) {
    if (button(gui, p.name, p.label, p.help, true, quarter)) turn(p.normal);
    ImGui::SameLine();
  }
  if (button(gui, "cut/to-the-eye", "Eye", "Cuts across the view: what is nearer to the eye is taken away.",
             true, quarter))
    turn((1.0 / length(camera.position - camera.target)) * (camera.position - camera.target));
  edit(gui, scene, "view.cut.normal", 0, {"Normal"});
  edit(gui, scene, "view.cut.offset", 0, {"Offset"});
}

/// Applied when the mouse lets go: the slider would run away from under it.
void text_size(Gui& gui, Layout& layout) {
  if (slider(
          gui, "Text size", "layout/text-size", layout.text_size, Layout::smallest_text, Layout::largest_text,
          "×%.2f",
          "Size of text and panels, a factor from 0.75 to 2.5 on that of the display: larger for a lecture "
          "hall. Remembered when the window is closed.\nDrag to change, Ctrl+click to type.",
          false))
    gui.set_text_size(layout.text_size);
}

}  // namespace

void view_section(Gui& gui, SceneControl& scene, CameraControl& camera, bool& shadows, Layout& layout) {
  edit(gui, scene, "view.draw");
  edit(gui, scene, "view.colour", 0, {"Colour by"});
  cut_widgets(gui, scene, camera.goal());
  edit(gui, scene, "view.arrows");
  if (scene.scene().view.arrows.any()) edit(gui, scene, "view.arrow-scale", 0, {"Force per length"});
  check_box(gui, "shadows", "view/shadows", shadows,
            "Shadows that bodies and balls cast on terrain. Without them pictures take less time. Affects "
            "this window only; aspic run always draws them.");
  edit(gui, scene, "view.axes");
  camera_buttons(gui, camera);
  edit_camera(gui, camera, "view.camera.position", "Camera");
  edit_camera(gui, camera, "view.camera.target", "Looks at");
  edit_camera(gui, camera, "view.camera.fov", "Field of view");
  edit_camera(gui, camera, "view.camera.projection", "Projection");
  text_size(gui, layout);
  if (button(gui, "layout/reset", "Reset layout",
             "Resets panels, their widths and the size of text to their defaults. Scene and camera are "
             "unchanged.",
             true, -1.0f)) {
    layout = Layout();
    gui.set_text_size(1.0);
  }
}

}  // namespace aspic::app
