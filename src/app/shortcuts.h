#pragma once
// The window's keys, once: what they are called, what they mean, what they do.
#include <span>
#include <string>
#include <string_view>

namespace aspic::app {

class App;

struct Shortcut {
  std::string_view keys;        ///< as people read it: "Ctrl+Z"
  std::string_view meaning;     ///< a phrase
  int key = -1;                 ///< GLFW key, or −1: by character
  int modifiers = 0;            ///< GLFW modifiers that must be held: of Ctrl and Shift, exactly these
  char32_t character = 0;       ///< where the key's place depends on the keyboard's layout
  void (*act)(App&) = nullptr;  ///< null for the mouse, which is told of only
};

/// All of them, in the order of the help page.
std::span<const Shortcut> shortcuts();

/// The keys of the shortcut with that meaning, for tooltips; empty if there is none.
std::string_view keys_of(std::string_view meaning);

/// Does what a key or character stands for; false if nothing.
bool act_on_key(App& app, int key, int modifiers);
bool act_on_character(App& app, char32_t character);

}  // namespace aspic::app
