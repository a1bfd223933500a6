#pragma once
// The panels around the scene. Widgets of scene values are made from the parameter table.
#include <cstddef>
#include <deque>

#include "app/film.h"
#include "app/gui.h"
#include "app/hands.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "app/pointer.h"
#include "app/run_control.h"
#include "app/samples.h"
#include "app/scene_control.h"
#include "app/scene_picture.h"
#include "app/simulation.h"
#include "app/view.h"

namespace aspic::app {

/// What the panels show and change; a section gets of it what it uses.
struct PanelParts {
  Gui& gui;
  Messages& messages;
  Simulation& simulation;
  View& view;
  SceneControl& scene;
  RunControl& run;
  ScenePicture& picture;
  Hands& hands;
  Film& film;
  const Pointer& pointer;
  Layout& layout;
  bool& help_visible;
};

/// Makes all panels of one picture, between Gui::begin and end; sizes in window units. Returns the place they
/// leave to the scene.
Box draw_panels(const PanelParts& parts, double width, double height);

// ---- sections of the panels; each a heading with its widgets ----
void scene_section(Gui& gui, SceneControl& scene);
void simulation_section(Gui& gui, Simulation& simulation, SceneControl& scene);
void bodies_section(Gui& gui, SceneControl& scene);
/// Size, place and turn of a cube.
void placed_cube(Gui& gui, SceneControl& scene, std::size_t cube);
void springs_section(Gui& gui, SceneControl& scene);
void contact_section(Gui& gui, SceneControl& scene);
void balls_section(Gui& gui, const Simulation& simulation, Hands& hands);
void view_section(Gui& gui, SceneControl& scene, CameraControl& camera, bool& shadows, Layout& layout);
void recording_section(Gui& gui, const std::string& source, Film& film);
/// A button for each format of states; part of the recording section.
void state_files(Gui& gui, const SceneEditor& editor, Simulation& simulation, Messages& messages);
void performance_section(Gui& gui, Simulation& simulation, const ScenePicture& picture);
void energy_section(Gui& gui, const std::deque<EnergySample>& energies);
void shadow_section(Gui& gui, const Simulation& simulation, RunControl& run);
void stability_section(Gui& gui, SceneControl& scene);

/// What is known of a particle, next to the mouse, or in a corner of the view while it is pulled.
void hover_tooltip(double scale, const Simulation& simulation, const Hovered& hovered, const Box& view);
/// The bar of the history, into that box.
void draw_timeline(Gui& gui, const Simulation& simulation, RunControl& run, const Box& box);

}  // namespace aspic::app
