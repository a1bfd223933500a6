#include "app/commands.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cassert>

namespace aspic::app {

std::string_view Commands::keys_of(std::string_view name) const {
  const auto found = std::ranges::find(rows_, name, &Command::name);
  return found == rows_.end() ? std::string_view() : found->keys;
}

void Commands::run(std::string_view name) const {
  const auto found = std::ranges::find(rows_, name, &Command::name);
  assert(found != rows_.end() && found->act);
  found->act();
}

void Commands::on_key(int key, int modifiers, bool held) const {
  const int of_interest = modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  for (const Command& c : rows_) {
    if (key >= 0 && (c.key == key || c.other_key == key) && c.modifiers == (of_interest & ~c.ignored) &&
        (c.repeats || !held))
      return c.act();
  }
}

void Commands::on_character(char32_t character) const {
  for (const Command& c : rows_) {
    if (c.character != 0 && c.character == character) return c.act();
  }
}

}  // namespace aspic::app
