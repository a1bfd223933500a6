#include <fmt/format.h>

#include <filesystem>

#include "aspic/scene.h"
#include "base/embedded_file.h"
#include "base/files.h"
#include "base/lines.h"
#include "base/printable.h"
#include "scene/diagnostics.h"
#include "scene/input_file.h"
#include "scene/reader.h"

namespace aspic {

std::span<const EmbeddedFile> builtin_scene_files();  // generated

namespace {

/// The end of every message about a name that leads nowhere.
std::string known_scenes(std::string_view name) {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : list_builtin_scenes()) names.push_back(scene.name);
  return fmt::format("built-in scenes are {}{}", diagnostics::list_text(names, false),
                     diagnostics::did_you_mean(diagnostics::nearest(name, names)));
}

constexpr std::string_view ending = ".toml";

/// The text of the first comment line.
std::string_view first_comment(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t start = line.find_first_not_of("# ");
  return start == std::string_view::npos ? std::string_view{} : line.substr(start);
}

}  // namespace

void reader::read_files(Reader& reader, const std::vector<diagnostics::Source>& sources,
                        const LoadOptions& options) {
  read_cell_files(reader, sources);
  read_meshes(reader, sources, options);
  read_actuator_files(reader, sources);
}

Result<Scene> load_scene(const std::string& file_or_builtin, std::span<const std::string> overrides,
                         const LoadOptions& options) {
  if (const auto text = builtin_scene_text(file_or_builtin)) {
    return parse_scene(*text, file_or_builtin + ".toml", overrides, options);
  }
  std::error_code error;
  if (!std::filesystem::exists(file_or_builtin, error)) {
    // A path was meant if it looks like one; any other word was meant as a name.
    if (file_or_builtin.find_first_of("/.") != std::string::npos) {
      const std::string stem = std::filesystem::path(file_or_builtin).stem().string();
      return fail(ErrorCode::io, "{}: no such file; {}", printable_line(file_or_builtin), known_scenes(stem));
    }
    return fail(ErrorCode::scene_rejected, "'{}' is neither a file nor a built-in scene; {}",
                printable_line(file_or_builtin), known_scenes(file_or_builtin));
  }
  const auto start = read_regular_file(file_or_builtin, checkpoint_mark.size());
  if (start && start->content == checkpoint_mark) {
    const std::string name = printable_line(file_or_builtin);
    return advised(fail(ErrorCode::scene_rejected, "{}: this is a checkpoint, not a scene.", name),
                   {{RemedyKind::resume, {name}}});
  }
  ASPIC_TRY(auto text, read_file(file_or_builtin));
  if (is_input_log(text)) {
    const std::string name = printable_line(file_or_builtin);
    return advised(fail(ErrorCode::scene_rejected, "{}: these are inputs of a run, not a scene.", name),
                   {{RemedyKind::replay, {name}}});
  }
  return parse_scene(text, file_or_builtin, overrides, options);
}

std::vector<BuiltinScene> list_builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  std::string_view group;
  for (std::string_view order = *find_embedded(builtin_scene_files(), "order.txt"); !order.empty();) {
    const std::string_view line = take_line(order);
    if (line.starts_with("# "))
      group = line.substr(2);
    else
      scenes.push_back({line, first_comment(*builtin_scene_text(line)), group});
  }
  return scenes;
}

std::optional<std::string_view> builtin_scene_text(std::string_view name) {
  return find_embedded(builtin_scene_files(), std::string(name).append(ending));
}

}  // namespace aspic
