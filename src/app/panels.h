#pragma once
// The panels around the scene. Widgets of scene values are made from the parameter table.
#include <imgui.h>

#include <cstddef>

#include "app/file_dialog.h"
#include "app/film.h"
#include "app/gui.h"
#include "app/hands.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "app/palette.h"
#include "app/pointer.h"
#include "app/run_control.h"
#include "app/scene_control.h"
#include "app/scene_picture.h"
#include "app/simulation.h"
#include "app/view.h"

namespace aspic::app {

/// Whether the window may go with changes that were not saved.
enum class Closing { no, asked, decided };

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
  FileDialog& files;
  Palette& palette;
  Closing& closing;
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
/// How pictures are saved; part of the recording section.
void picture_files(Gui& gui, SavedLook& look);
/// A button for each format of states; part of the recording section. The references must outlive `files`.
void state_files(Gui& gui, const SceneEditor& editor, Simulation& simulation, Messages& messages,
                 FileDialog& files);
void performance_section(Gui& gui, Simulation& simulation, const ScenePicture& picture);
void energy_section(Gui& gui, const Simulation& simulation, RunControl& run);
void shadow_section(Gui& gui, const Simulation& simulation, RunControl& run);
void stability_section(Gui& gui, SceneControl& scene);

/// What is known of a particle, in the lower left corner of the view, or where that is narrow and has a
/// legend in the upper right one.
void particle_readout(const Gui& gui, const Simulation& simulation, const Hovered& hovered, const Box& view,
                      bool legend);
/// What the colours mean, in the lower right corner of the view. Returns how much of its height is taken.
/// `name` is that of its widget.
double draw_legend(const Gui& gui, const char* name, const Legend& legend, const Box& view);
/// The world's axes, in the upper right corner of the view.
void draw_axes(const Gui& gui, const Camera& camera, const Box& view);
/// A colour as ImGui takes it, opaque.
ImU32 display_colour(const Colour& linear);

}  // namespace aspic::app
