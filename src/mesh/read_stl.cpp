// STL: triangles without shared vertices, as text or in 50 bytes each after a header of 84.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/lines.h"
#include "mesh/mesh_text.h"

namespace aspic {
namespace {

static_assert(std::endian::native == std::endian::little, "STL's numbers are little-endian");

constexpr std::size_t header_bytes = 84, triangle_bytes = 50, count_at = 80;

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

bool is_word(std::string_view word, std::string_view lower_case) {
  return std::ranges::equal(word, lower_case,
                            [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// The triangle over the last three vertices.
bool add_triangle(MeshBuilder& mesh, std::size_t place) {
  const auto count = static_cast<std::uint32_t>(mesh.vertex_count());
  return mesh.add_polygon(std::array{count - 3, count - 2, count - 1}, place);
}

Result<MeshFile> parse_binary(std::string_view bytes, const std::string& file_name) {
  const auto error = [&](std::size_t byte, const std::string& what) {
    return mesh_error_at_byte(file_name, byte, what);
  };
  if (bytes.size() < header_bytes)
    return error(bytes.size(),
                 "the file ends in its header of 84 bytes: it is truncated, or not an STL file");
  std::uint64_t count = number_at<std::uint32_t>(bytes, count_at);
  MeshBuilder mesh;
  // Programs that write as they go leave it at 0.
  if (const std::uint64_t rest = bytes.size() - header_bytes; count == 0 && rest % triangle_bytes == 0) {
    count = rest / triangle_bytes;
    if (count > 0)
      mesh.add_note(
          fmt::format("byte {}: the header declares 0 triangles, and the file has {}", count_at, count));
  }
  const std::uint64_t needed = header_bytes + count * triangle_bytes;
  if (needed > bytes.size())
    return error(count_at, fmt::format("the header declares {} triangles ({} bytes), and the file has {} "
                                       "bytes. The file is truncated: copy or export it again",
                                       count, needed, bytes.size()));
  if (count > most_mesh_triangles) return error(count_at, too_many_triangles());
  for (std::size_t at = header_bytes; at < needed; at += triangle_bytes) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t x = at + 12 + 12 * corner;  // after the normal, which the corners' order repeats
      mesh.add_vertex(
          {number_at<float>(bytes, x), number_at<float>(bytes, x + 4), number_at<float>(bytes, x + 8)});
    }
    if (!add_triangle(mesh, at)) return error(at, too_many_triangles());
  }
  if (needed < bytes.size())
    mesh.add_note(
        fmt::format("byte {}: ignored {} bytes after the last triangle", needed, bytes.size() - needed));
  return std::move(mesh).finish(count_at, error);
}

class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& file_name) : words_(text), file_name_(file_name) {}

  Result<MeshFile> read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (is_word(word, "solid") || is_word(word, "endsolid") || is_word(word, "facet") ||
          is_word(word, "outer")) {
        words_.skip_line();  // names and normals, which the corners' order repeats
      } else if (is_word(word, "vertex")) {
        ASPIC_CHECK(take_vertex());
      } else if (is_word(word, "endloop")) {
        if (corners_ != 3)
          return error(
              fmt::format("this facet has {} corners, and a facet of STL has 3; export triangles", corners_));
        corners_ = 0;
        if (!add_triangle(mesh_, words_.line())) return error(too_many_triangles());
      } else if (!is_word(word, "endfacet")) {
        return error(fmt::format(
            "{} is not a word of STL (facet, outer loop, vertex, endloop, endfacet); export the file again",
            quoted_word(word)));
      }
    }
    if (corners_ != 0) return error("the file ends inside a facet. It is truncated: copy or export it again");
    return std::move(mesh_).finish(words_.line(), [&](std::size_t line, const std::string& what) {
      return mesh_error_in_line(file_name_, line, what);
    });
  }

 private:
  Status take_vertex() {
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words_.next();
      const auto number = mesh_number(word);
      if (!number)
        return error(word.empty() ? "the file ends inside a vertex. It is truncated: copy or export it again"
                                  : fmt::format("{} is not a number; a corner is vertex 0.1 0.2 0.3",
                                                quoted_word(word)));
      position[axis] = *number;
    }
    mesh_.add_vertex(position);
    ++corners_;
    return {};
  }
  Error error(const std::string& what) const { return mesh_error_in_line(file_name_, words_.line(), what); }

  MeshWords words_;
  const std::string& file_name_;
  MeshBuilder mesh_;
  std::size_t corners_ = 0;
};

}  // namespace

Result<MeshFile> parse_stl(std::string_view bytes, const std::string& file_name) {
  const bool full = bytes.size() >= header_bytes &&
                    bytes.size() == header_bytes + std::uint64_t{number_at<std::uint32_t>(bytes, count_at)} *
                                                       triangle_bytes;
  if (!full && is_utf16(bytes))
    return mesh_error_at_byte(file_name, 0, fmt::format("this is {}", utf16_words));
  std::string_view text = bytes;
  skip_byte_order_mark(text);
  if (!full && is_word(MeshWords(text).next(), "solid") && text.find('\0') == std::string_view::npos)
    return AsciiReader(text, file_name).read();
  return parse_binary(bytes, file_name);
}

}  // namespace aspic
