// What keys do.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "app/app.h"

namespace aspic::app {

std::vector<Command> App::make_commands() {
  constexpr int ctrl = GLFW_MOD_CONTROL, shift = GLFW_MOD_SHIFT;
  const auto step = [this] {
    video.take();
    run.single_step();
    video.take();
  };
  const auto step_back = [this] {
    // After the window's own run diverged, of those that went on.
    if (comparison.clock().others_go_on())
      go_back(comparison.clock().setter().model().simulation.timestep);
    else
      run.step_back();
  };
  const auto reset = [this] {
    run.reset();
    if (messages.check(simulation.refresh_snapshot()) && !view.sees_bodies(simulation.snapshot()))
      messages.info("The bodies are outside the image: Home resets the camera, F frames the bodies.");
  };
  const auto toggle = [this] {
    if (!comparison.clock().toggle()) run.toggle();
  };
  const auto throw_ball = [this] { hands.throw_ball(pointer.sight(gui_->takes_mouse())); };
  const auto frame_bodies = [this] {
    if (messages.check(simulation.refresh_snapshot()) && messages.check(image.follow()))
      view.frame_bodies(simulation.model(), simulation.snapshot());
  };
  // Off, and in turn what there is to see.
  const auto cut = [this] {
    scene.change("view.cut", [](Scene& s) {
      constexpr int kinds = std::size(cut_insides);
      s.view.cut.inside = cut_insides[(static_cast<int>(s.view.cut.inside) + 1) % kinds].value;
    });
  };
  const auto axes = [this] { scene.change("view.axes", [](Scene& s) { s.view.axes = !s.view.axes; }); };
  const auto follow = [this] { follow_hovered(); };
  const auto full_screen = [this] {
    if (gui_->services().toggle_full_screen) gui_->services().toggle_full_screen();
  };
  // Cells that wait are what was done last.
  const auto undo = [this] {
    if (!cells.take_back()) scene.undo();
  };
  const auto layer_up = [this] { cells.choose_layer(cells.layer() + 1); };
  const auto layer_down = [this] { cells.choose_layer(cells.layer() - 1); };
  const auto paste = [this] { paste_camera(view, scene.scene(), gui_->services(), messages); };
  return {
      {"", "Motion"},
      {"Space", "start or pause", GLFW_KEY_SPACE, 0, 0, toggle, false, -1, ctrl},
      {". (full stop)", "single step", -1, 0, U'.', step},
      {"R", "reset to the start", GLFW_KEY_R, 0, 0, reset},
      {", (comma)", "step back", -1, 0, U',', step_back},
      {"Backspace", "half a second back", GLFW_KEY_BACKSPACE, 0, 0, [this] { go_back(0.5); }, true},
      {"+", "twice as fast", -1, 0, U'+', [this] { run.change_speed(2.0); }},
      {"-", "half as fast", -1, 0, U'-', [this] { run.change_speed(0.5); }},
      {"G", "other backend", GLFW_KEY_G, 0, 0, [this] { run.switch_backend(); }},
      {"", "Hands"},
      {"B", "throw a ball", GLFW_KEY_B, 0, 0, throw_ball},
      {"Ctrl+drag", "pull the particle or ball under the mouse"},
      {"Ctrl+right click", "pin or free the particle"},
      {"", "Scenes"},
      {"[", "previous scene", -1, 0, U'[', [this] { scene.open_neighbor(-1); }},
      {"]", "next scene", -1, 0, U']', [this] { scene.open_neighbor(1); }},
      {"Ctrl+L", "reload the scene", GLFW_KEY_L, ctrl, 0, [this] { scene.reload(); }},
      {"Ctrl+O", "open a scene, checkpoint or inputs", GLFW_KEY_O, ctrl, 0, [this] { ask_for_scene(); }},
      {"Ctrl+S", "save the scene", GLFW_KEY_S, ctrl, 0, [this] { ask_where_to_save(); }},
      {"F5", "reload the scene", GLFW_KEY_F5, 0, 0, [this] { scene.reload(); }},
      {"Ctrl+Z", "undo", GLFW_KEY_Z, ctrl, 0, undo, true},
      {"Ctrl+Shift+Z", "redo", GLFW_KEY_Z, ctrl | shift, 0, [this] { scene.redo(); }, true},
      {"Ctrl+Y", "redo", GLFW_KEY_Y, ctrl, 0, [this] { scene.redo(); }, true},
      {"", "Bodies and cells"},
      {"N", "add a body", GLFW_KEY_N, 0, 0, [this] { show_section(layout, "Bodies"); }},
      {"Ctrl+M", "add a mesh", GLFW_KEY_M, ctrl, 0, [this] { ask_for_mesh(); }},
      {"E", "edit cells, of the body under the mouse", GLFW_KEY_E, 0, 0, [this] { edit_hovered_cells(); }},
      {"left, right drag", "paint and erase cells of the layer that is shown"},
      {"middle click", "take the material of a cell"},
      {"1 … 9, 0", "the material to paint with, or the eraser"},
      {"Page Up", "the layer of cells above", GLFW_KEY_PAGE_UP, 0, 0, layer_up, true},
      {"Page Down", "the layer of cells below", GLFW_KEY_PAGE_DOWN, 0, 0, layer_down, true},
      {"", "Runs side by side"},
      {"Ctrl+B", "add a run side by side", GLFW_KEY_B, ctrl, 0, [this] { comparison_view.add(); }},
      {"Ctrl+G", "keep this run as ghost", GLFW_KEY_G, ctrl, 0, [this] { comparison_view.keep_ghost(); }},
      {"Ctrl+Shift+G", "remove the ghost", GLFW_KEY_G, ctrl | shift, 0,
       [this] { comparison_view.remove_ghost(); }},
      {"Ctrl+Shift+B", "close the comparison", GLFW_KEY_B, ctrl | shift, 0,
       [this] { comparison_view.leave(); }},
      {"", "Camera"},
      {"left drag", "turn the camera"},
      {"right or Shift drag", "move the camera"},
      {"wheel", "zoom to the point under the mouse"},
      {"double click", "look at the point under the mouse"},
      {"Home", "reset the camera", GLFW_KEY_HOME, 0, 0, [this] { view.camera.reset(); }},
      {"F", "frame the bodies", GLFW_KEY_F, 0, 0, frame_bodies},
      {"C", "follow the body under the mouse", GLFW_KEY_C, 0, 0, follow},
      {"Ctrl+C", "copy the camera as text", GLFW_KEY_C, ctrl, 0,
       [this] { copy_camera(view, gui_->services(), messages); }},
      {"Ctrl+V", "paste a camera", GLFW_KEY_V, ctrl, 0, paste},
      {"A", "axes in a corner of the image", GLFW_KEY_A, 0, 0, axes},
      {"O", "orthographic or perspective", GLFW_KEY_O, 0, 0, [this] { view.camera.change_projection(); }},
      {"X", "section: cut through the bodies, springs, off", GLFW_KEY_X, 0, 0, cut},
      {"", "Window and files"},
      {"L", "next layout", GLFW_KEY_L, 0, 0, [this] { layout.choose_next(); }},
      {"Tab", "hide or show the panels", GLFW_KEY_TAB, 0, 0, [this] { layout.panels = !layout.panels; }},
      {"Ctrl+P", "find an action, a scene or a value", GLFW_KEY_P, ctrl, 0,
       [this] { open_page(Page::palette); }},
      {"Ctrl++", "larger text", GLFW_KEY_EQUAL, ctrl, 0, [this] { layout.scale_text(1.1); }, true,
       GLFW_KEY_KP_ADD, shift},
      {"Ctrl+-", "smaller text", GLFW_KEY_MINUS, ctrl, 0, [this] { layout.scale_text(1.0 / 1.1); }, true,
       GLFW_KEY_KP_SUBTRACT, shift},
      {"F1", "all keys", GLFW_KEY_F1, 0, 0, [this] { open_page(help_visible ? Page::none : Page::help); }},
      {"F11", "full screen", GLFW_KEY_F11, 0, 0, full_screen},
      {"Ctrl+R", "start or end a video", GLFW_KEY_R, ctrl, 0, [this] { video.toggle(); }},
      {"F12", "save the image", GLFW_KEY_F12, 0, 0, [this] { shot_wanted_ = Shot::image; }},
      {"Shift+F12", "save the complete window", GLFW_KEY_F12, shift, 0,
       [this] { shot_wanted_ = Shot::window; }},
  };
}

}  // namespace aspic::app
