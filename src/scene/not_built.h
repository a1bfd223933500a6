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
inline bool is_builtin_scene(std::string_view name) {
  return std::find(builtin_scenes.begin(), builtin_scenes.end(), name) != builtin_scenes.end();
}

}  // namespace aspic::not_built
