// The sections that change the scene.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/app.h"
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
  return std::ranges::search(text, word, same).begin() != text.end() || word.empty();
}

/// A terrain of another shape with the same surface.
void terrain_button(App& app, const TerrainShapeRow& row, float width) {
  const std::string name = fmt::format("terrain/{}", row.name), label(row.title);
  const std::string help =
      fmt::format("Makes the first terrain a {} where its defaults put it. The motion goes on.", label);
  if (!button(app.gui(), name.c_str(), label.c_str(), help, "", true, width)) return;
  Scene scene = app.editor().scene();
  if (scene.model.terrain.empty()) scene.model.terrain.emplace_back();
  TerrainSettings& terrain = scene.model.terrain.front();
  TerrainSettings other;
  other.shape = row.value;
  other.mass = terrain.mass;
  other.restitution = terrain.restitution;
  other.friction = terrain.friction;
  terrain = other;
  app.apply(std::move(scene), "terrain shape", "");
}

void save_popup(App& app) {
  static constexpr const char* popup = "Save scene as";
  const float third = share_of_line(3);
  if (button(app.gui(), "scene/reload", "Reload", "Reads the file again; changes made here are dropped.",
             "reload the scene", true, third))
    app.reload();
  ImGui::SameLine();
  if (button(app.gui(), "scene/reset", "Reset", "Back to the scene's start.", "reset to the start", true,
             third))
    app.reset();
  ImGui::SameLine();
  if (button(app.gui(), "scene/save", "Save as…", "Writes the scene as it is now, with this camera.", "",
             true, third))
    ImGui::OpenPopup(popup);
  if (!ImGui::BeginPopup(popup)) return;
  static std::array<char, 512> path = {"my-scene.toml"};
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 16.0f);
  const bool entered =
      ImGui::InputText("##path", path.data(), path.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  tooltip("The file to write. One that exists is not overwritten.");
  ImGui::SameLine();
  if (button(app.gui(), "scene/save/write", "Write", "Writes the file.") || entered) {
    app.save_as(path.data());
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace

void scene_section(App& app) {
  static ImGuiTextFilter filter;
  ImGui::SetNextItemWidth(-1.0f);
  ImGui::InputTextWithHint("##search", "search scenes", filter.InputBuf, sizeof filter.InputBuf);
  app.gui().mark("scene/search");
  tooltip(
      "Shows scenes whose name or description holds this. A scene file is opened by dropping it on the "
      "window.");
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    const std::string_view word = filter.InputBuf;
    if (!holds(scene.name, word) && !holds(scene.description, word)) continue;
    const std::string name(scene.name);
    if (ImGui::Selectable(name.c_str(), name == app.editor().source())) app.open(name);
    app.gui().mark("scene/" + name);
    tooltip(scene.description);
  }
  if (app.editor().is_file()) {
    ImGui::Selectable(app.editor().source().c_str(), true);
    tooltip("A scene file. It is read again whenever it is written.");
  }
  const float half = share_of_line(2);
  for (const TerrainShapeRow& row : terrain_shapes) {
    if ((&row - terrain_shapes) % 2 != 0) ImGui::SameLine();
    terrain_button(app, row, half);
  }
  save_popup(app);
  const bool undo = app.editor().can_undo(), redo = app.editor().can_redo();
  const std::string undo_help = undo ? "Takes back: " + app.editor().undo_name() : "Nothing to take back.";
  const std::string redo_help = redo ? "Does again: " + app.editor().redo_name() : "Nothing to do again.";
  if (button(app.gui(), "scene/undo", "Undo", undo_help, "undo", undo, half)) app.undo();
  ImGui::SameLine();
  if (button(app.gui(), "scene/redo", "Redo", redo_help, "redo", redo, half)) app.redo();
}

void simulation_section(App& app) {
  Simulation& s = app.simulation();
  Gui& gui = app.gui();
  const float third = share_of_line(3);
  const bool diverged = s.divergence().has_value();
  if (button(gui, "simulation/run", s.running() ? "Pause" : "Start", "Starts or pauses the motion.",
             "start or pause", !diverged, third))
    app.toggle_running();
  ImGui::SameLine();
  if (button(gui, "simulation/step", "Step", "One time step; pauses first.", "single step", !diverged, third))
    app.single_step();
  ImGui::SameLine();
  if (button(gui, "simulation/reset", "Reset", "Back to the scene's start.", "reset to the start", true,
             third))
    app.reset();
  const float half = share_of_line(2);
  const std::string other = fmt::format("Switch to {}", next_backend(s.backend()).title);
  if (button(gui, "simulation/backend", other.c_str(),
             "Carries the state over to the other solver, to the bit.", "other backend", true, half))
    app.toggle_backend();
  ImGui::SameLine();
  const bool back = s.can_step_back();
  if (button(gui, "simulation/back", "Step back",
             "One time step back; the bar below the picture goes to any step since the start.", "step back",
             back, half))
    app.step_back();
  edit(app, "simulation.integrator");
  edit(app, "simulation.timestep", 0, {"Time step"});
  label_column("Pace");
  static constexpr const char* paces[] = {"steps per frame", "real time"};
  int pace = static_cast<int>(s.pace);
  if (ImGui::Combo("##pace", &pace, paces, 2)) s.pace = static_cast<Pace>(pace);
  gui.mark("simulation/pace");
  tooltip(
      "How fast simulated time passes: a fixed number of steps for each picture, or as fast as time itself. "
      "Where "
      "the solver cannot keep up, the factor in the status line says so.");
  if (s.pace == Pace::steps_per_frame) edit(app, "simulation.steps-per-frame");
  label_column("Speed");
  const double slowest = 1.0 / 1024.0, fastest = 1024.0;
  ImGui::SliderScalar("##speed", ImGuiDataType_Double, &s.speed, &slowest, &fastest, "×%.4g",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  gui.mark("simulation/speed");
  tooltip("Factor on the pace, from 1/1024 to 1024. Keys + and - double and halve it.");
  edit(app, "simulation.gravity");
  // The cube that the assignments speak of; all else of it, and other bodies, stand under Bodies.
  if (!app.editor().scene().model.cubes.empty()) placed_cube(app, 0);
  if (app.editor().scene().model.simulation.integrator == Integrator::implicit_euler) {
    edit(app, "simulation.implicit.newton-iterations");
    edit(app, "simulation.implicit.cg-iterations");
    edit(app, "simulation.implicit.tolerance");
  }
}

}  // namespace aspic::app
