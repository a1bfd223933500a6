#pragma once
// From text to Scene: parsing, validation and --set in one go. A rejected text changes nothing.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "base/result.h"
#include "scene/scene.h"

namespace aspic {

/// What a scene has to fit into.
struct LoadLimits {
  std::optional<std::uint64_t> memory_bytes;  ///< absent: what the system says is available now
};

/// Reads a scene from TOML text. Messages name `file_name`. `overrides` are KEY=VALUE arguments of
/// --set, later ones winning; a key is a path of the parameter table with indices
/// (`cube[0].shear.stiffness`), a value is a TOML value or a bare word. Error (scene_rejected): the first
/// TOML syntax error alone, or every semantic error at once, sorted by line and separated by blank lines.
/// Each names file, line and column (or the --set argument) and shows the line with a caret.
Result<Scene> parse_scene(std::string_view text, const std::string& file_name,
                          std::span<const std::string> overrides = {}, const LoadLimits& limits = {});

/// A scene with KEY=VALUE arguments of --set applied to it, and checked. Errors: as parse_scene; a complaint
/// that is not about an argument names the key instead of a line.
Result<Scene> with_overrides(Scene scene, std::span<const std::string> overrides,
                             const LoadLimits& limits = {});

/// The same for arguments of --view: keys of the table `view`, without its name.
Result<Scene> with_view(Scene scene, std::span<const std::string> arguments, const LoadLimits& limits = {});

/// Reads a built-in scene by name, or else a file (write `./cube-plane` for a file with a built-in's name).
/// Errors: as parse_scene; io for a path that cannot be read; scene_rejected for a name nobody knows, with
/// the list of names and the nearest one, and for a file that is no text, a checkpoint for one.
Result<Scene> load_scene(const std::string& file_or_builtin, std::span<const std::string> overrides = {},
                         const LoadLimits& limits = {});

/// A scene that is part of the program.
struct BuiltinScene {
  std::string_view name;
  std::string_view description;  ///< one line: the file's first comment
  std::string_view group;        ///< the heading that it is listed under
};

/// All built-in scenes, in the order in which they are listed for users.
std::vector<BuiltinScene> list_builtin_scenes();

/// The file of a built-in scene as it was written, comments and all; nothing for an unknown name.
std::optional<std::string_view> builtin_scene_text(std::string_view name);

}  // namespace aspic
