#pragma once
// What the readers of meshes share: words and numbers of text, errors with a place, polygons as triangles.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/read_mesh.h"

namespace aspic {

/// "bunny.obj:12: …", of a line counted from 1.
Error mesh_error_in_line(const std::string& file_name, std::size_t line, const std::string& what);
/// "bunny.stl: byte 84: …", counted from 0.
Error mesh_error_at_byte(const std::string& file_name, std::size_t byte, const std::string& what);
/// A word of a file for a message: on one line, and not all of a long one.
std::string quoted_word(std::string_view word);

/// A number as mesh files write them: also nan, inf and the same in Microsoft's words (1.#QNAN); too large
/// ones are infinite, too small ones 0. Nothing: it is no number.
std::optional<double> mesh_number(std::string_view word);
/// A whole number.
std::optional<std::int64_t> mesh_integer(std::string_view word);

/// A text word by word.
class MeshWords {
 public:
  explicit MeshWords(std::string_view text, std::size_t first_line = 1) : rest_(text), line_(first_line) {}
  /// The next word, empty at the end of the text.
  std::string_view next();
  /// Passes over what is left of the line.
  void skip_line();
  std::size_t line() const { return line_; }  ///< of the word before

 private:
  std::string_view rest_;
  std::size_t line_;
};

/// Puts a mesh together. A file may name vertices before it gives them, so the largest index is checked at
/// the end.
class MeshBuilder {
 public:
  /// Where something is: a line or a byte, as the reader's own error takes it.
  using Place = std::size_t;

  void add_vertex(const Vec3& position) { file_.mesh.vertices.push_back(position); }
  std::size_t vertex_count() const { return file_.mesh.vertices.size(); }
  /// A polygon over vertices counted from 0, each below 2³². One of less than three corners is passed over
  /// and counted. False: there are more than most_mesh_triangles.
  [[nodiscard]] bool add_polygon(std::span<const std::uint32_t> corners, Place place);
  void add_note(std::string note) { file_.notes.push_back(std::move(note)); }

  /// The mesh. Error, made by `error(place, what)`: a vertex that there is not; no triangle, at `end`.
  template <class MakeError>
  Result<MeshFile> finish(Place end, const MakeError& error) && {
    if (const auto wrong = wrong_index()) return error(largest_place_, *wrong);
    if (file_.mesh.triangles.empty()) return error(end, no_faces());
    note_short_faces();
    cut_polygons();
    return std::move(file_);
  }

 private:
  std::optional<std::string> wrong_index() const;
  std::string no_faces() const;
  void note_short_faces();
  void cut_polygons();

  /// The triangles of a polygon of more than three corners.
  struct Polygon {
    std::size_t first, count;
  };
  MeshFile file_;
  std::vector<Polygon> polygons_;
  std::optional<std::uint32_t> largest_;
  Place largest_place_ = 0;
  std::size_t short_faces_ = 0;
};

/// What to say of more than most_mesh_triangles.
std::string too_many_triangles();

}  // namespace aspic
