#include "mesh/mesh_text.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "base/printable.h"
#include "mesh/polygon.h"

namespace aspic {
namespace {

constexpr std::string_view blanks = " \t\v\f", line_ends = "\r\n";

}  // namespace

Error mesh_error_in_line(const std::string& file_name, std::size_t line, const std::string& what) {
  return fail(ErrorCode::scene_rejected, "{}:{}: {}", printable_line(file_name), line, what);
}

Error mesh_error_at_byte(const std::string& file_name, std::size_t byte, const std::string& what) {
  return fail(ErrorCode::scene_rejected, "{}: byte {}: {}", printable_line(file_name), byte, what);
}

std::string quoted_word(std::string_view word) {
  return fmt::format("'{}'", excerpt(word, 40));
}

std::optional<double> mesh_number(std::string_view word) {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.find(".#") != std::string_view::npos) return not_a_number;
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc()) return value;
  // Out of range: what is too small has a negative exponent, or zeros alone before its first digit.
  const std::size_t exponent = word.find_first_of("eE");
  const bool small = exponent == std::string_view::npos
                         ? word.find_first_not_of("-0.") > word.find('.')
                         : exponent + 1 < word.size() && word[exponent + 1] == '-';
  return small ? 0.0 : std::numeric_limits<double>::infinity();
}

std::optional<std::int64_t> mesh_integer(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error != std::errc()) return std::nullopt;
  return value;
}

std::string_view MeshWords::next() {
  while (!rest_.empty()) {
    if (rest_.front() == '\n' || (rest_.front() == '\r' && !rest_.starts_with("\r\n")))
      ++line_;
    else if (rest_.front() != '\r' && blanks.find(rest_.front()) == std::string_view::npos)
      break;
    rest_.remove_prefix(1);
  }
  const std::size_t end = std::min(rest_.find_first_of(" \t\r\v\f\n"), rest_.size());
  const std::string_view word = rest_.substr(0, end);
  rest_.remove_prefix(end);
  return word;
}

void MeshWords::skip_line() {
  rest_.remove_prefix(std::min(rest_.find_first_of(line_ends), rest_.size()));
}

bool MeshBuilder::add_polygon(std::span<const std::uint32_t> corners, Place place) {
  for (const std::uint32_t corner : corners) {
    if (largest_ && corner <= *largest_) continue;
    largest_ = corner;
    largest_place_ = place;
  }
  if (corners.size() < 3) {
    ++short_faces_;
    return true;
  }
  if (file_.mesh.triangles.size() + (corners.size() - 2) > most_mesh_triangles) return false;
  if (corners.size() > 3) polygons_.push_back({file_.mesh.triangles.size(), corners.size() - 2});
  for (std::size_t i = 2; i < corners.size(); ++i)
    file_.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  return true;
}

void MeshBuilder::cut_polygons() {
  TriangleMesh& mesh = file_.mesh;
  std::size_t fans = 0;
  for (const auto& [first, count] : polygons_)
    if (!cut_polygon(mesh.vertices, std::span(mesh.triangles).subspan(first, count))) ++fans;
  if (fans > 0)
    add_note(
        fmt::format("concave faces of more than {} corners, split into triangles from the first corner: {}",
                    most_cut_corners, fans));
}

std::optional<std::string> MeshBuilder::wrong_index() const {
  if (!largest_ || *largest_ < vertex_count()) return std::nullopt;
  return fmt::format(
      "this face names vertex {}, counted from 0, and the file has {}. The file is truncated or damaged: "
      "export it again",
      *largest_, vertex_count());
}

std::string MeshBuilder::no_faces() const {
  if (vertex_count() == 0)
    return "there is no vertex and no face: the file holds no mesh, or has another format";
  return fmt::format(
      "there are {} vertices and no face: points alone have no inside; export the surface as triangles",
      vertex_count());
}

void MeshBuilder::note_short_faces() {
  if (short_faces_ > 0)
    add_note(fmt::format("faces of less than three corners were left out: {}", short_faces_));
}

std::string too_many_triangles() {
  return fmt::format("there are more than {} triangles; reduce the mesh: a body of cells needs far fewer",
                     most_mesh_triangles);
}

}  // namespace aspic
