// The sections that change the scene, or throw balls into it.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "aspic/scene.h"
#include "base/printable.h"
#include "model/terrain.h"

namespace aspic::app {
namespace {

/// A terrain of another shape with the same surface.
void terrain_button(Gui& gui, SceneControl& scenes, const TerrainShapeRow& row, float width) {
  const std::string name = fmt::format("terrain/{}", row.name), label(row.title);
  const std::string help = fmt::format("Turns the first terrain into a {}. Restarts the simulation.", label);
  if (!button(gui, name.c_str(), label.c_str(), help, true, width)) return;
  scenes.change("terrain shape", [&](Scene& scene) {
    if (scene.model.terrain.empty()) scene.model.terrain.emplace_back();
    TerrainSettings& terrain = scene.model.terrain.front();
    TerrainSettings other;
    other.shape = row.value;
    other.mass = terrain.mass;
    other.restitution = terrain.restitution;
    other.friction = terrain.friction;
    terrain = other;
  });
}

void scene_buttons(Gui& gui, const SceneEditor& editor) {
  const float half = share_of_line(2), third = share_of_line(3);
  command_button(gui, "scene/open", "Open…", "Opens a scene, a checkpoint at its step, or inputs to replay.",
                 "open a scene, checkpoint or inputs", true, third);
  ImGui::SameLine();
  command_button(gui, "scene/save", "Save…", "Writes the scene with its changes and this camera.",
                 "save the scene", true, third);
  ImGui::SameLine();
  command_button(gui, "scene/reload", "Reload", "Reloads the scene and discards changes made here.",
                 "reload the scene", true, third);
  const bool undo = editor.can_undo(), redo = editor.can_redo();
  command_button(gui, "scene/undo", "Undo",
                 undo ? "Undo " + editor.undo_name() : std::string("Nothing to undo."), "undo", undo, half);
  ImGui::SameLine();
  command_button(gui, "scene/redo", "Redo",
                 redo ? "Redo " + editor.redo_name() : std::string("Nothing to redo."), "redo", redo, half);
}

/// Where the heading of a group goes that begins with a scene: to the right end of its row, since headings of
/// their own would push what follows out of sight; to the left in a line before it where the two would touch.
struct GroupHeading {
  GroupHeading(const std::string& scene, std::string_view group) : text(group) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const auto width = [](const std::string& words) { return ImGui::CalcTextSize(words.c_str()).x; };
    place = ImGui::GetWindowContentRegionMax().x - width(text) - style.FramePadding.x;
    fits = text.empty() || ImGui::GetCursorPosX() + width(scene) + 2.0f * style.ItemSpacing.x <= place;
    if (!fits) ImGui::TextDisabled("%s", text.c_str());
  }
  void after_scene() const {
    if (!fits || text.empty()) return;
    ImGui::SameLine(place);
    ImGui::TextDisabled("%s", text.c_str());
  }
  std::string text;
  float place;
  bool fits;
};

}  // namespace

void scene_section(Gui& gui, SceneControl& scene) {
  static ImGuiTextFilter filter;
  ImGui::SetNextItemWidth(filter.IsActive() ? -ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x
                                            : -1.0f);
  const bool entered = ImGui::InputTextWithHint("##search", "search scenes", filter.InputBuf,
                                                sizeof filter.InputBuf, ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive() || entered) filter.Build();
  named(gui, "scene/search", "Filters scenes by name or description. Enter opens the only match.");
  if (filter.IsActive()) {
    ImGui::SameLine();
    if (button(gui, "scene/search/clear", "×", "Shows all scenes.", true, ImGui::GetFrameHeight()))
      filter.Clear();
  }
  std::vector<std::string> hits;
  std::string_view group;
  // Of a search, those with the words in their names first.
  std::vector<BuiltinScene> scenes = list_builtin_scenes();
  if (filter.IsActive())
    std::stable_partition(scenes.begin(), scenes.end(), [](const BuiltinScene& builtin) {
      return filter.PassFilter(std::string(builtin.name).c_str());
    });
  for (const BuiltinScene& builtin : scenes) {
    const std::string name(builtin.name), description(builtin.description);
    const bool hit = filter.PassFilter(name.c_str()) || filter.PassFilter(description.c_str());
    if (hit) hits.push_back(name);
    const bool open = name == scene.editor().source();
    if (!hit && !open) continue;  // the one that is open stays in sight
    const bool first = std::exchange(group, builtin.group) != builtin.group;
    const GroupHeading heading(name, first ? builtin.group : std::string_view());
    if (ImGui::Selectable(name.c_str(), open)) scene.open(name);
    named(gui, "scene/" + name, description);
    heading.after_scene();
  }
  if (entered && hits.size() == 1) {
    scene.open(hits.front());
    filter.Clear();
  }
  const std::vector<std::string> files = scene.files();
  for (const std::string& file : files) {
    const std::string name = printable(std::filesystem::path(file).filename().string());
    const std::string shown = elided_path(name, ImGui::GetContentRegionAvail().x);
    if (ImGui::Selectable(fmt::format("{}##{}", shown, file).c_str(), file == scene.editor().source()))
      scene.open(file);
    named(gui, "scene/" + file,
          fmt::format("{}\n\nAspic reloads it when the file changes.", printable(file)));
  }
  const float half = share_of_line(2);
  group_heading("Terrain");
  for (const TerrainShapeRow& row : terrain_shapes) {
    if ((&row - terrain_shapes) % 2 != 0) ImGui::SameLine();
    terrain_button(gui, scene, row, half);
  }
  scene_buttons(gui, scene.editor());
}

void simulation_section(Gui& gui, PlaybackSession& s, SceneControl& scene, const Comparison& comparison) {
  const float third = share_of_line(3), half = share_of_line(2);
  const bool diverged = s.divergence().has_value();
  const bool runs = s.running() || comparison.clock().others_run();
  command_button(gui, "simulation/run", runs ? "Pause" : "Start", "Starts or pauses the motion.",
                 "start or pause", !diverged || comparison.clock().others_go_on(), third);
  ImGui::SameLine();
  command_button(gui, "simulation/step", "Step", "Makes one time step, and pauses first.", "single step",
                 !diverged, third);
  ImGui::SameLine();
  command_button(gui, "simulation/reset", "Reset", "Returns to the scene's start.", "reset to the start",
                 true, third);
  const std::string other = fmt::format("Switch to {}", next_backend(s.present().backend()).title);
  command_button(gui, "simulation/backend", other.c_str(),
                 "Switches to the other solver; the state keeps every bit.", "other backend", true, half);
  ImGui::SameLine();
  command_button(gui, "simulation/back", "Step back", "Goes back one time step.", "step back",
                 s.playback().can_step_back(), half);
  edit(gui, scene, "simulation.integrator");
  edit(gui, scene, "simulation.timestep", 0, {"Time step"});
  label_column("Pace");
  static constexpr std::string_view paces[] = {"steps per frame", "real time"};
  Pacer& pacer = s.pacer();
  auto pace = static_cast<std::size_t>(pacer.pace());
  if (choice(gui, "simulation/pace", paces, paces, pace, "Sets the pace: steps per frame, or real time."))
    pacer.set_pace(static_cast<Pace>(pace));
  if (pacer.pace() == Pace::steps_per_frame) edit(gui, scene, "simulation.steps-per-frame");
  double speed = pacer.speed();
  slider(gui, "Speed", "simulation/speed", speed, slowest_speed, fastest_speed, "×%.4g",
         "Sets the factor on the pace, from 1/1024 to 1024. Keys: + and -");
  pacer.set_speed(speed);
  edit(gui, scene, "simulation.gravity");
  // The cube that the assignments speak of; the rest of it, and other bodies, are under Bodies.
  if (!scene.scene().model.cubes.empty()) placed_cube(gui, scene, 0);
  if (row_of(scene.scene().model.simulation.integrator).kind() == MethodKind::newton) {
    edit(gui, scene, "simulation.implicit.newton-iterations");
    edit(gui, scene, "simulation.implicit.cg-iterations", 0, {"CG iterations"});
    edit(gui, scene, "simulation.implicit.tolerance");
  }
}

void balls_section(Gui& gui, const PlaybackSession& simulation, Hands& hands) {
  const float third = share_of_line(3);
  command_button(gui, "balls/throw", "Throw",
                 "Throws a ball into the middle of the image. Key: at the mouse.", "throw a ball", true,
                 third);
  ImGui::SameLine();
  if (button(gui, "balls/many", "Throw many", "Throws a dozen balls.", true, third)) hands.throw_many();
  ImGui::SameLine();
  const std::size_t thrown = simulation.present().setup().thrown.size();
  if (button(gui, "balls/clear", "Clear",
             thrown > 0 ? fmt::format("Removes the {} thrown balls; those of the scene stay.", thrown)
                        : std::string("There are no thrown balls; those of the scene stay."),
             thrown > 0, third))
    hands.clear_balls();
  slider(gui, "Radius", "balls/radius", hands.radius, 0.02, 2.0, "%.3g m",
         "Sets the radius of the next thrown ball [m], 0.02 to 2.");
  slider(gui, "Mass", "balls/mass", hands.mass, 0.01, 1000.0, "%.3g kg",
         "Sets the mass of the next thrown ball [kg], 0.01 to 1000.");
  slider(gui, "Speed", "balls/speed", hands.speed, 0.5, 200.0, "%.3g m/s",
         "Sets the speed of the next thrown ball [m/s], 0.5 to 200.");
  slider(gui, "Pull", "balls/strength", hands.strength, 0.01, 100.0, "×%.3g",
         "Sets the strength of Ctrl+drag, 0.01 to 100. The time step limits it.");
  ImGui::TextDisabled("%zu of the scene, %zu thrown",
                      static_cast<std::size_t>(simulation.model().ball_count()) - thrown, thrown);
}

}  // namespace aspic::app
