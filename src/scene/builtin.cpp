#include <span>

#include "base/embedded_file.h"
#include "scene/load.h"

namespace aspic {

std::span<const EmbeddedFile> builtin_scene_files();  // generated

namespace {

constexpr std::string_view ending = ".toml";

/// The text of the first comment line.
std::string_view first_comment(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t start = line.find_first_not_of("# ");
  return start == std::string_view::npos ? std::string_view{} : line.substr(start);
}

}  // namespace

std::vector<BuiltinScene> list_builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  for (const EmbeddedFile& file : builtin_scene_files()) {
    scenes.push_back({file.name.substr(0, file.name.size() - ending.size()), first_comment(file.text)});
  }
  return scenes;
}

std::optional<std::string_view> builtin_scene_text(std::string_view name) {
  return find_embedded(builtin_scene_files(), std::string(name).append(ending));
}

}  // namespace aspic
