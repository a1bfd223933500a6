#pragma once
// The panels around the scene. Widgets of scene values are made from the parameter table.
#include "app/gui.h"

namespace aspic::app {

class App;

/// Makes all panels of one picture, between Gui::begin and end; sizes in window units. Returns the place they
/// leave to the scene.
Box draw_panels(App& app, double width, double height);

// ---- sections of the panels; each a heading with its widgets ----
void scene_section(App& app);
void simulation_section(App& app);
/// Size, place and turn of a cube.
void placed_cube(App& app, std::size_t cube);
void bodies_section(App& app);
void springs_section(App& app);
void contact_section(App& app);
void view_section(App& app);
void recording_section(App& app);
void performance_section(App& app);
void energy_section(App& app);
void balls_section(App& app);
void shadow_section(App& app);
/// What is known of the particle under the mouse, beside it.
void hover_tooltip(App& app);
/// Of the gpu, by kind of pass; part of the performance section.
void pass_times(App& app);
/// The bar of the history, into that box.
void draw_timeline(App& app, const Box& box);

}  // namespace aspic::app
