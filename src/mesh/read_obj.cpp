// Wavefront OBJ. Its numbers are counted from 1, or back from the last vertex where they are negative.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/lines.h"
#include "mesh/mesh_text.h"

namespace aspic {
namespace {

/// Lines without a meaning for a solid: directions, textures, names, materials, points, lines.
constexpr std::array passed_over = {
    "vn", "vt",     "vp",  "g",      "o",     "s",        "usemtl",   "mtllib",     "p",        "l",
    "mg", "usemap", "lod", "maplib", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"};
/// Surfaces that are no triangles.
constexpr std::array free_forms = {"curv", "curv2", "surf", "cstype", "bzp", "bsp", "cdc", "cdp", "res"};

template <class Words>
bool among(const Words& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

/// A comment begins with # where a word would; Microsoft's 1.#QNAN has none.
std::string_view without_comment(std::string_view line) {
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1))
    if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') return line.substr(0, at);
  return line;
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file_name) : rest_(text), file_name_(file_name) {}

  Result<MeshFile> read() {
    while (!rest_.empty()) {
      ++line_;
      std::string_view line = take_line(rest_);
      std::size_t lines = 1;
      if (line.ends_with('\\')) line = joined(line, lines);
      ASPIC_CHECK(take(without_comment(line)));
      line_ += lines - 1;
    }
    return std::move(mesh_).finish(std::max<std::size_t>(line_, 1),
                                   [&](std::size_t line, const std::string& what) {
                                     return mesh_error_in_line(file_name_, line, what);
                                   });
  }

 private:
  /// A line that continues on the next ones.
  std::string_view joined(std::string_view line, std::size_t& lines) {
    joined_.clear();
    while (line.ends_with('\\') && !rest_.empty()) {
      line.remove_suffix(1);
      joined_.append(line).push_back(' ');
      line = take_line(rest_);
      ++lines;
    }
    joined_.append(line);
    if (joined_.ends_with('\\')) joined_.pop_back();
    return joined_;
  }

  Status take(std::string_view line) {
    MeshWords words(line);
    const std::string_view key = words.next();
    if (key == "v") return take_vertex(words);
    if (key == "f" || key == "fo") return take_face(words);
    if (key.empty() || among(passed_over, key)) return {};
    if (among(free_forms, key))
      return error(fmt::format(
          "{} describes a free-form surface, which Aspic does not read; export triangles", quoted_word(key)));
    if (!noted_) mesh_.add_note(fmt::format("line {}: ignored the unknown {}", line_, quoted_word(key)));
    noted_ = true;
    return {};
  }

  Status take_vertex(MeshWords& words) {
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      const auto number = mesh_number(word);
      if (!number) {
        return error(word.empty() ? "this vertex has less than three numbers; a vertex is v 0.1 0.2 0.3"
                                  : fmt::format("{} is not a number{}", quoted_word(word),
                                                word.find(',') == std::string_view::npos
                                                    ? "; a vertex is v 0.1 0.2 0.3"
                                                    : "; export with decimal points, not commas"));
      }
      position[axis] = *number;
    }
    mesh_.add_vertex(position);
    return {};
  }

  Status take_face(MeshWords& words) {
    corners_.clear();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const std::string_view digits = word.substr(0, word.find('/'));
      const auto number = mesh_integer(digits);
      if (!number || *number == 0)
        return error(fmt::format("{} names no vertex: they are counted from 1, or from -1 backwards",
                                 quoted_word(word)));
      const auto known = static_cast<std::int64_t>(mesh_.vertex_count());
      const std::int64_t index = *number > 0 ? *number - 1 : known + *number;
      if (index < 0)
        return error(fmt::format("{} names a vertex before the first: there are {} up to this line",
                                 quoted_word(word), known));
      if (index >= 0xffffffff)
        return error(fmt::format("{} names no vertex: it is too large", quoted_word(word)));
      corners_.push_back(static_cast<std::uint32_t>(index));
    }
    if (!mesh_.add_polygon(corners_, line_)) return error(too_many_triangles());
    return {};
  }

  Error error(const std::string& what) const { return mesh_error_in_line(file_name_, line_, what); }

  std::string_view rest_;
  const std::string& file_name_;
  std::size_t line_ = 0;
  MeshBuilder mesh_;
  std::vector<std::uint32_t> corners_;
  std::string joined_;
  bool noted_ = false;
};

}  // namespace

Result<MeshFile> parse_obj(std::string_view text, const std::string& file_name) {
  skip_byte_order_mark(text);
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    return mesh_error_at_byte(file_name, zero, "this is a binary file, and OBJ is text: export it again");
  return ObjReader(text, file_name).read();
}

}  // namespace aspic
