#pragma once
// The panels around the scene. Widgets of scene values are made from the parameter table.
#include <imgui.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cell_editor.h"
#include "app/comparison_view.h"
#include "app/file_dialog.h"
#include "app/gui.h"
#include "app/hands.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "app/palette.h"
#include "app/pointer.h"
#include "app/run_control.h"
#include "app/scene_control.h"
#include "app/scene_image.h"
#include "app/video.h"
#include "app/view.h"
#include "model/bodies.h"
#include "playback/playback_session.h"
#include "playback/stability_map.h"

namespace aspic::app {

/// Whether the window may go with changes that were not saved.
enum class Closing { no, asked, decided };

/// What the panels show and change; a section gets of it what it uses.
struct PanelParts {
  Gui& gui;
  Messages& messages;
  PlaybackSession& simulation;
  View& view;
  SceneControl& scene;
  RunControl& run;
  SceneImage& image;
  Hands& hands;
  Video& video;
  const Pointer& pointer;
  Layouts& layout;
  FileDialog& files;
  Palette& palette;
  Comparison& comparison;
  ComparisonView& comparison_view;
  Closing& closing;
  bool& help_visible;
  CellEditor& cells;
  StabilityMap& stability;
};

/// The sections by heading, each with what is in it.
std::vector<std::pair<std::string, std::string>> section_names();
/// Opens a section by heading, in a layout that has it, and scrolls it into sight.
void show_section(Layouts& layout, std::string_view name);

/// Makes all panels of one image, between Gui::begin and end; sizes in window units. The runs get the place
/// that they leave.
void draw_panels(const PanelParts& parts, double width, double height);

// ---- sections of the panels; each a heading with its widgets ----
void scene_section(Gui& gui, SceneControl& scene);
void simulation_section(Gui& gui, PlaybackSession& simulation, SceneControl& scene,
                        const Comparison& comparison);
void bodies_section(Gui& gui, SceneControl& scene, PlaybackSession& simulation, CellEditor& cells,
                    Layouts& layout);
/// Layers of a body of cells, painted with the mouse, and its palette.
void cells_section(Gui& gui, SceneControl& scene, CellEditor& cells);
/// Materials that have names.
void materials_section(Gui& gui, SceneControl& scene, Messages& messages);
/// What a body of a section, `cube[]`, is made of.
void made_of_row(Gui& gui, SceneControl& scene, std::string_view section, std::size_t index);
/// A line that names an element of a list, with a button that removes it. True if it was pressed.
bool element_line(Gui& gui, const std::string& title, const std::string& name, std::string_view help,
                  bool enabled);
/// Adds an actuator that acts on a body; all actuators with their keys, and what inputs they have now.
/// Nothing where scenes have none.
void add_actuator_button(Gui& gui, SceneControl& scene, std::string_view key, std::size_t index);
void actuators_of_bodies(Gui& gui, SceneControl& scene, PlaybackSession& simulation);
/// Removes a body from a scene: the camera does not follow it any more, and no actuator acts on it.
void remove_body(Scene& scene, const SettingsList& bodies, std::size_t index);
/// The color in which the window shows a material by name, and cells of a body; neutral for none.
ImU32 material_color(const ModelSettings& settings, std::string_view name);
ImU32 cell_color(const ModelSettings& settings, const VoxelsSettings& voxels, char cell);
/// The material of such cells in words.
std::string material_text(const VoxelsSettings& voxels, char cell);
/// Size, place and turn of a cube.
void placed_cube(Gui& gui, SceneControl& scene, std::size_t cube);
void springs_section(Gui& gui, SceneControl& scene, Layouts& layout);
void contact_section(Gui& gui, SceneControl& scene);
void balls_section(Gui& gui, const PlaybackSession& simulation, Hands& hands);
/// `shown`: the ends of the scale of colors in the image.
void view_section(Gui& gui, SceneControl& scene, CameraControl& camera, const QuantityRange& shown,
                  bool& shadows, Layouts& layout);
void scale_rows(Gui& gui, SceneControl& scene, const QuantityRange& shown);
/// The camera moves along with a body or ball of the scene by name (scene/follow.h), or with none. Undo takes
/// it back.
void set_followed(SceneControl& scene, const std::optional<std::string>& name);
/// The names there are to choose from.
std::vector<std::string> followed_names(const Scene& scene);
void recording_section(Gui& gui, const std::string& source, Video& video);
/// How images are saved; part of the recording section.
void image_files(Gui& gui, SavedLook& look);
/// A button for each format of states; part of the recording section. The references but `source` must
/// outlive `files`.
void state_files(Gui& gui, const std::string& source, PlaybackSession& simulation,
                 ComparisonView& comparison_view, Messages& messages, FileDialog& files);
void performance_section(Gui& gui, PlaybackSession& simulation, const Comparison& comparison,
                         const SceneImage& image);
void energy_section(Gui& gui, ComparisonView& comparison_view, RunControl& run, Layouts& layout);
void comparison_section(Gui& gui, SceneControl& scene, ComparisonView& comparison_view);
void shadow_section(Gui& gui, const PlaybackSession& simulation, RunControl& run);
void stability_section(Gui& gui, SceneControl& scene, StabilityMap& map);

/// What is known of a particle, in the lower left corner of the view, above what is in its way there. Returns
/// its place.
Box particle_readout(const Gui& gui, const PlaybackSession& simulation, const Hovered& hovered,
                     const Box& view, std::span<const Box> taken);
/// A ring around the ball under the mouse, and the band by which `hand` pulls it, where the image is.
void ball_mark(const Gui& gui, const std::optional<Pull>& hand, const Hovered& hovered, const View& view,
               const Box& image);
/// The layer of cells that is edited, where it is in the image, at the run's start.
void draw_edited_layer(const PanelParts& parts);
/// What the colors mean, in the lower right corner of the view. Returns its place, with the gap below and
/// next to it; empty if there is none. `name` is that of its widget.
Box draw_legend(const Gui& gui, const char* name, const Legend& legend, const Box& view);
/// ImGui's name of the window of the n-th message.
inline std::string notice_window(std::size_t n) {
  return "##notice" + std::to_string(n);
}
/// Labels of the runs compared; what colors and arrows mean, one above the other; the time in large
/// figures; what is under the mouse; and the world's axes where these leave room, in the upper right corner
/// if they can.
void draw_corners(const PanelParts& parts, const Box& view);
/// The messages, over the view; the page of keys; and what is asked before changes are lost.
void notice_panels(const PanelParts& parts, const Box& view);
void help_panel(Gui& gui, bool& visible, double width, double height);
void closing_panel(Gui& gui, Closing& closing, double width, double height);
/// Where ImGui's window is that is being made.
Box window_box();
/// A color as ImGui takes it, opaque.
ImU32 display_color(const Color& linear);

}  // namespace aspic::app
