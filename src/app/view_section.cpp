// The section of the image: the things drawn, the camera, and the size of text.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "scene/follow.h"

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
    {"camera/front", "Front", {0, 0, 1}, "Looks at the target from the front, along −z."},
    {"camera/side", "Side", {1, 0, 0}, "Looks at the target from the right, along −x."},
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
  command_button(gui, "camera/frame", "Frame bodies", "Moves the camera until all bodies are in the image.",
                 "frame the bodies", true, half);
  command_button(gui, "camera/copy", "Copy", "Copies the camera as a line for [view] of a scene file.",
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
    {"cut/x", "X", "Cuts across the x axis and hides the side of larger x.", {1, 0, 0}},
    {"cut/y", "Y", "Cuts across the y axis and hides the upper side.", {0, 1, 0}},
    {"cut/z", "Z", "Cuts across the z axis and hides the side of larger z.", {0, 0, 1}},
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
  if (button(gui, "cut/to-the-eye", "Eye",
             "Cuts parallel to the screen and hides the half nearer the camera.", true, quarter))
    turn((1.0 / length(camera.position - camera.target)) * (camera.position - camera.target));
  edit(gui, scene, "view.cut.normal", 0, {"Normal"});
  edit(gui, scene, "view.cut.offset", 0, {"Offset"});
}

/// Applied when the mouse lets go: the slider would run away from under it.
void text_size(Gui& gui, Layout& layout) {
  static double dragged = 1.0;
  static bool held = false;
  if (!held) dragged = layout.text_size;
  if (slider(gui, "Text size", "layout/text-size", dragged, Layout::smallest_text, Layout::largest_text,
             "×%.2f", "Sets the size of text and panels, 0.75 to 2.5.\nDrag to change, Ctrl+click to type.",
             false))
    layout.text_size = dragged;
  held = ImGui::IsItemActive();
}

void layout_widgets(Gui& gui, Layouts& layout) {
  std::vector<std::string_view> names, titles;
  std::string help = "Arranges the window; each layout keeps its own changes.\n";
  for (const LayoutRow& row : layouts()) {
    names.push_back(row.name);
    titles.push_back(row.title);
    help += fmt::format("\n{}: {}", row.title, row.summary);
  }
  auto index = static_cast<std::size_t>(&layout.row() - layouts().data());
  label_column("Layout");
  if (choice(gui, "layout/name", names, titles, index,
             fmt::format("{}\n\nKey: {}", help, gui.commands().keys_of("next layout"))))
    layout.choose(layouts()[index]);
  text_size(gui, layout);
  check_box(gui, "large clock", "layout/clock", layout.clock,
            "Shows a large clock in a corner, except in videos and comparisons.");
  if (button(gui, "layout/reset", "Reset layout", "Resets the panels, their widths and the text size.", true,
             -1.0f))
    layout.reset();
}

void follow_choice(Gui& gui, SceneControl& scene) {
  const std::vector<std::string> known = followed_names(scene.scene());
  std::vector<std::string_view> names = {"nothing"};
  names.insert(names.end(), known.begin(), known.end());
  const std::string& now = scene.scene().view.follow.value_or("nothing");
  auto index = static_cast<std::size_t>(std::ranges::find(names, now) - names.begin());
  if (index == names.size()) names.push_back(now);
  label_column("Follow");
  const Parameter& p = *find_parameter("view.follow");
  if (choice(gui, "view.follow", names, names, index,
             fmt::format("{} The key {} follows the body under the mouse.\n\nScene key: view.follow",
                         p.meaning, gui.commands().keys_of("follow the body under the mouse"))))
    set_followed(scene, index == 0 ? std::nullopt : std::optional(std::string(names[index])));
}

}  // namespace

void set_followed(SceneControl& scene, const std::optional<std::string>& name) {
  scene.change("follow", [&](Scene& s) { s.view.follow = name; });
}

std::vector<std::string> followed_names(const Scene& scene) {
  constexpr std::uint64_t most_balls = 24;  // any other is one that the mouse points at
  return followable(scene.model, most_balls);
}

void view_section(Gui& gui, SceneControl& scene, CameraControl& camera, const QuantityRange& shown,
                  bool& shadows, Layouts& layout) {
  edit(gui, scene, "view.draw");
  edit(gui, scene, "view.color", 0, {"Color by"});
  scale_rows(gui, scene, shown);
  cut_widgets(gui, scene, camera.goal());
  layout_widgets(gui, layout);
  if (!folded(gui, layout, "View", "more", "Arrows, terrain, ground, shadows, axes, and the camera.")) return;
  edit(gui, scene, "view.arrows");
  if (scene.scene().view.arrows.any()) edit(gui, scene, "view.arrow-scale", 0, {"Force per length"});
  edit(gui, scene, "view.terrain");
  edit(gui, scene, "view.ground", 0, {"Grid at height"});
  check_box(gui, "shadows", "view/shadows", shadows,
            "Shows shadows on terrain in this window. Frames take less time without.");
  edit(gui, scene, "view.axes");
  camera_buttons(gui, camera);
  follow_choice(gui, scene);
  edit_camera(gui, camera, "view.camera.position", "Camera");
  edit_camera(gui, camera, "view.camera.target", "Looks at");
  edit_camera(gui, camera, "view.camera.fov", "Field of view");
  edit_camera(gui, camera, "view.camera.projection", "Projection");
}

}  // namespace aspic::app
