#pragma once
// From TOML and --set arguments to a Scene, along the parameter table.
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "scene/document.h"
#include "scene/parameters.h"
#include "scene/scene_checks.h"

namespace aspic::reader {

using diagnostics::Position;
using diagnostics::Problem;

/// Where a path of the scene was written last, and the faults of its value.
struct Written {
  Position key, value;
  std::vector<Position> elements;  ///< of an array's elements; of pinned, names before indices
  std::optional<Problem> problem;
  const FormerKey* former = nullptr;  ///< the name by which it was written, unless its own
};

/// Reads keys into a scene and remembers where each was written. A key that is written again replaces value,
/// place and problem.
class Reader {
 public:
  /// The keys are read into `scene`: an empty one for a file's text, another for --set alone.
  Reader(Scene scene, bool has_text) : scene_(std::move(scene)), has_text_(has_text) {}

  Scene& scene() { return scene_; }
  const std::map<std::string, Written>& written() const { return written_; }
  /// The paths that were written at a path and below it.
  std::vector<std::string> written_in(const std::string& path) const;
  void fail(const Position& at, std::string message) { problems_.push_back({at, std::move(message)}); }

  /// Reads every member of the table at `path` ("" is the file, `cube[]` an element of a list).
  void read_table(const toml::table& table, std::string_view path, std::size_t index, std::uint32_t source);
  /// Reads one member of the table at `path`; `former`: it has this former name there.
  void read_member(std::string_view path, std::size_t index, std::string_view key, const Position& at,
                   const toml::node& value, std::uint32_t source, const FormerKey* former = nullptr);
  /// Notes a table on the way to a key, where none was written.
  void enter(std::string_view path, std::size_t index, const Position& at);
  /// Forgets a path and everything below it: the values that are there now were not written.
  void forget(const std::string& path);

  /// Of two keys that exclude each other, forgets that at `other` where the text wrote it and an argument
  /// `path`.
  void prefer_argument(const std::string& path, const std::string& other);

  /// Keys of an element of a section, `cube[]`, that were written although a material would decide them.
  std::vector<std::string> explicit_keys(std::string_view section, std::size_t index) const;

  /// Values of the keys that cells come from (is_cell_source(), is_actuator_source()), by path.
  const std::map<std::string, Value>& cell_sources() const { return cell_sources_; }
  /// What is wrong with the value of a path that was written.
  void blame(const std::string& path, std::string message);

  /// All problems: those of reading, and those of the scene (check_scene), each where its key was written. A
  /// complaint about a key that could not be read, or that depends on one, is left out.
  std::vector<Problem> problems(std::optional<std::uint64_t> memory_bytes) const;

 private:
  void read_named(const toml::table& table, std::string_view path, std::uint32_t source);
  void read_list(const toml::node& value, std::string_view path, Written& written, std::uint32_t source);
  void read_parameter(const Parameter& p, const toml::node& value, std::size_t index, Written& written);
  bool has_problem(const std::string& path) const;
  void check_materials(std::vector<Problem>& problems) const;
  Problem located(const SceneComplaint& complaint) const;

  Scene scene_;
  bool has_text_;
  std::map<std::string, Written> written_;  // by path with indices
  std::map<std::string, Value> cell_sources_;
  std::vector<Problem> problems_;  // of keys that are not in the table, and of arguments
};

/// Puts the cells of files in the place of layers. Paths are relative to the scene's file, or of arguments to
/// the working directory.
void read_cell_files(Reader& reader, const std::vector<diagnostics::Source>& sources);
/// The same of meshes, with size and skin.
void read_meshes(Reader& reader, const std::vector<diagnostics::Source>& sources, const LoadOptions& options);

/// The same of masks and phases of actuators.
void read_actuator_files(Reader& reader, const std::vector<diagnostics::Source>& sources);
/// All three.
void read_files(Reader& reader, const std::vector<diagnostics::Source>& sources, const LoadOptions& options);

/// Whether a key of [[voxels]] names where cells come from: it is read once, and no scene has it.
bool is_cell_source(std::string_view path);
/// The same of [[actuator]].
bool is_actuator_source(std::string_view path);

}  // namespace aspic::reader

namespace aspic::overrides {

/// KEY=VALUE arguments.
struct Arguments {
  std::span<const std::string> texts;
  const std::string& origin;  ///< what messages put before each: the option that it was given by, or nothing
};

/// Reads each argument into the reader's scene, in order, and adds one source for each.
///
/// A `material` key takes the place of the scene's masses and springs; masses and springs take the place of
/// the scene's material only if all seven are given. A new terrain shape takes the place of geometry keys it
/// does not have.
void apply(const Arguments& arguments, reader::Reader& reader, std::vector<diagnostics::Source>& sources);
/// An element of a list that may have a material.
struct BodyInList {
  std::string_view list;
  std::size_t index;
};
/// Decides between material and explicit springs where arguments changed what the scene had chosen.
void resolve_material(reader::Reader& reader, const BodyInList& body, bool had_material);
/// Takes out the scene's geometry where an argument chose a shape that does not have it.
void resolve_shape(reader::Reader& reader, std::size_t terrain);

/// The same for keys of the table `view`, without its name.
void apply_view(const Arguments& arguments, reader::Reader& reader,
                std::vector<diagnostics::Source>& sources);

}  // namespace aspic::overrides
