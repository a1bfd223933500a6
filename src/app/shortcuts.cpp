#include "app/shortcuts.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

#include "app/app.h"

namespace aspic::app {
namespace {

constexpr int ctrl = GLFW_MOD_CONTROL, shift = GLFW_MOD_SHIFT;

using Row = Shortcut;

const std::array table = {
    Row{"Space", "start or pause", GLFW_KEY_SPACE, 0, 0, [](App& a) { a.toggle_running(); }},
    Row{".", "single step", -1, 0, U'.', [](App& a) { a.single_step(); }},
    Row{"R", "reset to the start", GLFW_KEY_R, 0, 0, [](App& a) { a.reset(); }},
    Row{",", "step back", -1, 0, U',', [](App& a) { a.step_back(); }},
    Row{"Backspace", "half a second back", GLFW_KEY_BACKSPACE, 0, 0, [](App& a) { a.jump_back(); }},
    Row{"+", "twice as fast", -1, 0, U'+', [](App& a) { a.change_speed(2.0); }},
    Row{"-", "half as fast", -1, 0, U'-', [](App& a) { a.change_speed(0.5); }},
    Row{"G", "other backend", GLFW_KEY_G, 0, 0, [](App& a) { a.toggle_backend(); }},
    Row{"B", "throw a ball", GLFW_KEY_B, 0, 0, [](App& a) { a.throw_ball(); }},
    Row{"Ctrl+drag", "pull the particle under the mouse", -1, 0, 0, nullptr},
    Row{"Ctrl+right click", "pin or free the particle", -1, 0, 0, nullptr},
    Row{"[", "previous scene", -1, 0, U'[', [](App& a) { a.open_neighbour(-1); }},
    Row{"]", "next scene", -1, 0, U']', [](App& a) { a.open_neighbour(1); }},
    Row{"Ctrl+L", "reload the scene", GLFW_KEY_L, ctrl, 0, [](App& a) { a.reload(); }},
    Row{"F5", "reload the scene", GLFW_KEY_F5, 0, 0, [](App& a) { a.reload(); }},
    Row{"Ctrl+Z", "undo", GLFW_KEY_Z, ctrl, 0, [](App& a) { a.undo(); }},
    Row{"Ctrl+Shift+Z", "redo", GLFW_KEY_Z, ctrl | shift, 0, [](App& a) { a.redo(); }},
    Row{"Ctrl+Y", "redo", GLFW_KEY_Y, ctrl, 0, [](App& a) { a.redo(); }},
    Row{"left drag", "turn the camera", -1, 0, 0, nullptr},
    Row{"right or Shift drag", "move the camera", -1, 0, 0, nullptr},
    Row{"wheel", "nearer or farther", -1, 0, 0, nullptr},
    Row{"double click", "turn to what is there", -1, 0, 0, nullptr},
    Row{"Home", "reset the camera", GLFW_KEY_HOME, 0, 0, [](App& a) { a.camera().reset(); }},
    Row{"F", "frame the bodies", GLFW_KEY_F, 0, 0, [](App& a) { a.frame_bodies(); }},
    Row{"Ctrl+C", "copy the camera as text", GLFW_KEY_C, ctrl, 0, [](App& a) { a.copy_camera(); }},
    Row{"Ctrl+V", "paste a camera", GLFW_KEY_V, ctrl, 0, [](App& a) { a.paste_camera(); }},
    Row{"Tab", "hide or show the panels", GLFW_KEY_TAB, 0, 0, [](App& a) { a.toggle_panels(); }},
    Row{"F1", "all keys", GLFW_KEY_F1, 0, 0, [](App& a) { a.toggle_help(); }},
    Row{"F11", "full screen", GLFW_KEY_F11, 0, 0, [](App& a) { a.toggle_full_screen(); }},
    Row{"Ctrl+R", "start or end a film", GLFW_KEY_R, ctrl, 0, [](App& a) { a.toggle_recording(); }},
    Row{"F12", "save a screenshot", GLFW_KEY_F12, 0, 0, [](App& a) { a.take_screenshot(); }},
};

}  // namespace

std::span<const Shortcut> shortcuts() {
  return table;
}

std::string_view keys_of(std::string_view meaning) {
  const auto found = std::ranges::find(table, meaning, &Shortcut::meaning);
  return found == table.end() ? std::string_view() : found->keys;
}

bool act_on_key(App& app, int key, int modifiers) {
  if (key < 0) return false;
  for (const Shortcut& s : table) {
    if (s.key != key || s.modifiers != (modifiers & (ctrl | shift))) continue;
    s.act(app);
    return true;
  }
  return false;
}

bool act_on_character(App& app, char32_t character) {
  for (const Shortcut& s : table) {
    if (s.character == 0 || s.character != character) continue;
    s.act(app);
    return true;
  }
  return false;
}

}  // namespace aspic::app
