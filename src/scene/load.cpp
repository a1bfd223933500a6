#include "scene/load.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/files.h"
#include "scene/diagnostics.h"
#include "scene/document.h"
#include "scene/overrides.h"
#include "scene/reader.h"

namespace aspic {
namespace {

/// Far beyond any scene: keeps a device or a wrong file from filling the memory.
constexpr std::uint64_t largest_file = 64 << 20;

/// The end of every message about a name that leads nowhere.
std::string known_scenes(std::string_view name) {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : list_builtin_scenes()) names.push_back(scene.name);
  return fmt::format("built-in scenes are {}{}", diagnostics::list_text(names, false),
                     diagnostics::did_you_mean(diagnostics::nearest(name, names)));
}

}  // namespace

std::optional<std::uint64_t> available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string key;
    std::uint64_t kibibytes = 0;
    if (words >> key >> kibibytes && key == "MemAvailable:") return kibibytes * 1024;
  }
  return std::nullopt;
}

Result<Scene> parse_scene(std::string_view text, const std::string& file_name,
                          std::span<const std::string> overrides, const LoadLimits& limits) {
  std::vector<diagnostics::Source> sources = {{file_name, std::string(text), true}};
  auto parsed = document::parse(text, 0);
  if (const auto* problem = std::get_if<document::Problem>(&parsed))
    return diagnostics::rejection(sources, {*problem});
  auto& root = std::get<document::Node>(parsed);
  std::vector<document::Problem> problems;
  overrides::apply(overrides, root, sources, problems);
  Scene scene = reader::read(root, limits.memory_bytes ? limits.memory_bytes : available_memory(), problems);
  if (!problems.empty()) return diagnostics::rejection(sources, std::move(problems));
  if (!document::find(root, "name")) scene.name = std::filesystem::path(file_name).stem().string();
  return scene;
}

Result<Scene> load_scene(const std::string& file_or_builtin, std::span<const std::string> overrides,
                         const LoadLimits& limits) {
  if (const auto text = builtin_scene_text(file_or_builtin)) {
    return parse_scene(*text, file_or_builtin + ".toml", overrides, limits);
  }
  std::error_code error;
  if (!std::filesystem::exists(file_or_builtin, error)) {
    // A path was meant if it looks like one; any other word was meant as a name.
    if (file_or_builtin.find_first_of("/.") != std::string::npos) {
      const std::string stem = std::filesystem::path(file_or_builtin).stem().string();
      return Error{ErrorCode::io, fmt::format("{}: no such file; {}", file_or_builtin, known_scenes(stem))};
    }
    return Error{ErrorCode::scene_rejected, fmt::format("'{}' is neither a file nor a built-in scene; {}",
                                                        file_or_builtin, known_scenes(file_or_builtin))};
  }
  auto text = read_file(file_or_builtin, largest_file);
  if (!text) return text.error();
  return parse_scene(*text, file_or_builtin, overrides, limits);
}

}  // namespace aspic
