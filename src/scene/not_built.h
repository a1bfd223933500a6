#pragma once
// Features of the scene format that this version refuses by name. Building one means deleting its line.
#include <algorithm>
#include <array>
#include <string_view>

namespace aspic::not_built {

/// Tables of a scene file.
inline constexpr std::array<std::string_view, 3> sections = {
    "goal-net",
    "ball",
    "launcher",
};

/// A word of a key.
struct Word {
  std::string_view path, word;
};
inline constexpr std::array<Word, 1> words = {{
    {"simulation.integrator", "implicit-euler"},
}};

/// Built-in scenes.
inline constexpr std::array<std::string_view, 4> builtin_scenes = {
    "goal-net",
    "penalty",
    "ball-pit",
    "cube-and-balls",
};

inline bool is_section(std::string_view name) {
  return std::find(sections.begin(), sections.end(), name) != sections.end();
}
inline bool is_word(std::string_view path, std::string_view word) {
  return std::any_of(words.begin(), words.end(),
                     [&](const Word& w) { return w.path == path && w.word == word; });
}
inline bool is_builtin_scene(std::string_view name) {
  return std::find(builtin_scenes.begin(), builtin_scenes.end(), name) != builtin_scenes.end();
}

}  // namespace aspic::not_built
