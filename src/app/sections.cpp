// The sections that change the scene.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "model/terrain.h"
#include "scene/load.h"

namespace aspic::app {
namespace {

bool holds(std::string_view text, std::string_view word) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return word.empty() || std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

/// A terrain of another shape with the same surface.
void terrain_button(Gui& gui, SceneControl& scenes, const TerrainShapeRow& row, float width) {
  const std::string name = fmt::format("terrain/{}", row.name), label(row.title);
  const std::string help =
      fmt::format("Turns the first terrain into a {} at its default place. Restarts the simulation.", label);
  if (!button(gui, name.c_str(), label.c_str(), help, true, width)) return;
  Scene scene = scenes.scene();
  if (scene.model.terrain.empty()) scene.model.terrain.emplace_back();
  TerrainSettings& terrain = scene.model.terrain.front();
  TerrainSettings other;
  other.shape = row.value;
  other.mass = terrain.mass;
  other.restitution = terrain.restitution;
  other.friction = terrain.friction;
  terrain = other;
  scenes.apply(std::move(scene), "terrain shape");
}

void scene_buttons(Gui& gui, const SceneEditor& editor) {
  const float half = share_of_line(2), third = share_of_line(3);
  command_button(gui, "scene/open", "Open…", "Opens a scene file.", "open a scene file", true, third);
  ImGui::SameLine();
  command_button(gui, "scene/save", "Save…", "Writes the scene as it is now, with this camera.",
                 "save the scene", true, third);
  ImGui::SameLine();
  command_button(gui, "scene/reload", "Reload", "Reloads the scene; changes made here are discarded.",
                 "reload the scene", true, third);
  const bool undo = editor.can_undo(), redo = editor.can_redo();
  command_button(gui, "scene/undo", "Undo",
                 undo ? "Undo " + editor.undo_name() : std::string("Nothing to undo."), "undo", undo, half);
  ImGui::SameLine();
  command_button(gui, "scene/redo", "Redo",
                 redo ? "Redo " + editor.redo_name() : std::string("Nothing to redo."), "redo", redo, half);
}

}  // namespace

void scene_section(Gui& gui, SceneControl& scene) {
  static std::array<char, 64> search = {};
  const std::string_view word = search.data();
  const bool clears = !word.empty();
  ImGui::SetNextItemWidth(clears ? -ImGui::GetFrameHeight() - ImGui::GetStyle().ItemSpacing.x : -1.0f);
  const bool entered = ImGui::InputTextWithHint("##search", "search scenes", search.data(), search.size(),
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  named(gui, "scene/search",
        "Shows scenes whose name or description contains this. A scene file is opened by dropping it on the "
        "window. Enter opens the only scene that is left.");
  if (clears) {
    ImGui::SameLine();
    if (button(gui, "scene/search/clear", "×", "Shows all scenes.", true, ImGui::GetFrameHeight()))
      search = {};
  }
  std::vector<std::string> hits;
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    const std::string name(builtin.name);
    const bool hit = holds(builtin.name, word) || holds(builtin.description, word);
    if (hit) hits.push_back(name);
    const bool open = name == scene.editor().source();
    if (!hit && !open) continue;  // the one that is open stays in sight
    if (ImGui::Selectable(name.c_str(), open)) scene.open(name);
    named(gui, "scene/" + name, builtin.description);
  }
  if (entered && hits.size() == 1) {
    scene.open(hits.front());
    search = {};
  }
  if (scene.editor().is_file()) {
    ImGui::Selectable(scene.editor().source().c_str(), true);
    tooltip("A scene file. It is reloaded whenever it is written.");
  }
  const float half = share_of_line(2);
  ImGui::TextDisabled("Terrain");
  for (const TerrainShapeRow& row : terrain_shapes) {
    if ((&row - terrain_shapes) % 2 != 0) ImGui::SameLine();
    terrain_button(gui, scene, row, half);
  }
  scene_buttons(gui, scene.editor());
}

void simulation_section(Gui& gui, Simulation& s, SceneControl& scene) {
  const float third = share_of_line(3), half = share_of_line(2);
  const bool diverged = s.divergence().has_value();
  command_button(gui, "simulation/run", s.running() ? "Pause" : "Start", "Starts or pauses the motion.",
                 "start or pause", !diverged, third);
  ImGui::SameLine();
  command_button(gui, "simulation/step", "Step", "Takes one time step; pauses first.", "single step",
                 !diverged, third);
  ImGui::SameLine();
  command_button(gui, "simulation/reset", "Reset", "Returns to the scene's start.", "reset to the start",
                 true, third);
  const std::string other = fmt::format("Switch to {}", next_backend(s.backend()).title);
  command_button(gui, "simulation/backend", other.c_str(),
                 "Switches to the other solver; the state keeps every bit.", "other backend", true, half);
  ImGui::SameLine();
  command_button(gui, "simulation/back", "Step back",
                 "Goes back one time step; the bar below the picture goes to any step since the start.",
                 "step back", s.can_step_back(), half);
  edit(gui, scene, "simulation.integrator");
  edit(gui, scene, "simulation.timestep", 0, {"Time step"});
  label_column("Pace");
  static constexpr std::string_view paces[] = {"steps per frame", "real time"};
  Pacer& pacer = s.pacer();
  auto pace = static_cast<std::size_t>(pacer.pace);
  if (choice(gui, "simulation/pace", paces, paces, pace,
             "How fast simulated time passes: a fixed number of steps for each picture, or real time. Where "
             "the solver cannot keep up, the factor in the status line says so."))
    pacer.pace = static_cast<Pace>(pace);
  if (pacer.pace == Pace::steps_per_frame) edit(gui, scene, "simulation.steps-per-frame");
  slider(gui, "Speed", "simulation/speed", pacer.speed, slowest_speed, fastest_speed, "×%.4g",
         "Factor on the pace, from 1/1024 to 1024. Keys + and - double and halve it.");
  edit(gui, scene, "simulation.gravity");
  // The cube that the assignments speak of; the rest of it, and other bodies, are under Bodies.
  if (!scene.scene().model.cubes.empty()) placed_cube(gui, scene, 0);
  if (row_of(scene.scene().model.simulation.integrator).solved()) {
    edit(gui, scene, "simulation.implicit.newton-iterations");
    edit(gui, scene, "simulation.implicit.cg-iterations");
    edit(gui, scene, "simulation.implicit.tolerance");
  }
}

}  // namespace aspic::app
