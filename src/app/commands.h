#pragma once
// What keys and buttons do: a table, of which the window fills in the actions.
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic::app {

struct Command {
  std::string_view keys;        ///< for people: "Ctrl+Z"; empty: a heading of the help page
  std::string_view name;        ///< a phrase, by which buttons refer to the command
  int key = -1;                 ///< printed_key(), or −1: by character, or by the mouse
  int modifiers = 0;            ///< GLFW modifiers, of Ctrl and Shift exactly these
  char32_t character = 0;       ///< for keys whose place depends on the keyboard's layout; 0: none
  std::function<void()> act{};  ///< empty for what the mouse does, which only the help page lists
  bool repeats = false;         ///< while the key is held
  int other_key = -1;           ///< another GLFW key that does the same
  int ignored = 0;              ///< GLFW modifiers that may be held as well: a pull needs Ctrl
};

/// The GLFW key of what a keyboard's layout prints on a key (glfwGetKeyName), so that shortcuts follow the
/// printed letter: keys of text alone, and of these the ones that print ASCII; the others are as they were.
int printed_key(int key, const char* printed);
int printed_key(int key);

class Commands {
 public:
  Commands() = default;
  explicit Commands(std::vector<Command> rows) : rows_(std::move(rows)) {}

  /// All of them, in the order of the help page.
  const std::vector<Command>& rows() const { return rows_; }
  /// The keys of the command of that name, for tooltips; empty if there is none.
  std::string_view keys_of(std::string_view name) const;
  /// Carries out the command of that name, which exists and has an action.
  void run(std::string_view name) const;
  /// Carries out the command of a key or character, if there is one. `held`: the key repeats.
  void on_key(int key, int modifiers, bool held) const;
  void on_character(char32_t character) const;

 private:
  std::vector<Command> rows_;
};

}  // namespace aspic::app
