#include "app/commands.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cassert>

namespace aspic::app {

int printed_key(int key, const char* printed) {
  const bool of_text = key > GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT;
  if (!of_text || !printed || static_cast<unsigned char>(printed[0]) >= 0x80 || printed[0] == '\0')
    return key;
  const char c = printed[0];
  return c == '+' ? GLFW_KEY_EQUAL : c >= 'a' && c <= 'z' ? c - 'a' + GLFW_KEY_A : c;
}

int printed_key(int key) {
  return printed_key(key, glfwGetKeyName(key, 0));
}

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
