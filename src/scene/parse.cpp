// Scenes of text and KEY=VALUE arguments. Pages that simulate do the same in a browser, without files.
#include <string_view>
#include <utility>

#include "aspic/scene.h"
#include "base/memory.h"
#include "scene/aim.h"
#include "scene/diagnostics.h"
#include "scene/document.h"
#include "scene/reader.h"

namespace aspic {
namespace {

/// A file's name without folder and ending. std::filesystem is no part of a browser's library.
std::string_view stem_of(std::string_view file) {
  file.remove_prefix(file.find_last_of('/') + 1);
  const std::size_t ending = file.find_last_of('.');
  return ending == 0 ? file : file.substr(0, ending);
}

/// A table that was written and no signal, or before it: then it is the signal.
void choose_signals(reader::Reader& reader) {
  for (std::size_t i = 0; i < reader.scene().model.actuators.size(); ++i) {
    const auto table = reader.written().find(path_text("actuator[].table", i));
    const auto signal = reader.written().find(path_text("actuator[].signal", i));
    if (table == reader.written().end()) continue;
    if (signal == reader.written().end() || signal->second.key.source < table->second.key.source)
      reader.scene().model.actuators[i].signal = Signal::table;
  }
}

Result<Scene> with_arguments(reader::Reader reader, std::vector<diagnostics::Source> sources,
                             std::span<const std::string> overrides, const LoadOptions& options,
                             decltype(overrides::apply) apply = overrides::apply) {
  apply({overrides, options.origin}, reader, sources);
  choose_signals(reader);
  reader::read_files(reader, sources, options);
  auto problems = reader.problems(options.memory_bytes ? options.memory_bytes : available_memory());
  if (!problems.empty()) return diagnostics::rejection(sources, std::move(problems));
  if (reader.scene().view.aimed) aim_at_bodies(reader.scene());
  return std::move(reader.scene());
}

}  // namespace

Result<Scene> parse_scene(std::string_view text, const std::string& file_name,
                          std::span<const std::string> overrides, const LoadOptions& options) {
  const auto parsed = document::parse(text, 0);
  std::vector<diagnostics::Source> sources = {{file_name, std::string(text)}};
  if (const auto* problem = std::get_if<diagnostics::Problem>(&parsed))
    return diagnostics::rejection(sources, {*problem});
  reader::Reader reader({}, true);
  reader.scene().view.aimed = true;  // until a key of the camera is read
  reader.read_table(std::get<toml::table>(parsed), "", 0, 0);
  if (!reader.written().contains("name")) reader.scene().name = stem_of(file_name);
  return with_arguments(std::move(reader), std::move(sources), overrides, options);
}

Result<Scene> with_overrides(Scene scene, std::span<const std::string> overrides,
                             const LoadOptions& options) {
  std::vector<diagnostics::Source> sources = {{scene.name, "", diagnostics::Source::none}};
  return with_arguments({std::move(scene), false}, std::move(sources), overrides, options);
}

Result<Scene> with_view(Scene scene, std::span<const std::string> arguments, const LoadOptions& options) {
  if (arguments.empty()) return scene;
  std::vector<diagnostics::Source> sources = {{scene.name, "", diagnostics::Source::none}};
  return with_arguments({std::move(scene), false}, std::move(sources), arguments, options,
                        overrides::apply_view);
}

}  // namespace aspic
