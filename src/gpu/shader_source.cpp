#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>

#include "base/files.h"
#include "base/lines.h"
#include "base/printable.h"
#include "gpu/lattice_links.h"
#include "model/terrain.h"

namespace aspic::gl {
namespace {

/// What follows `# word` on a line that starts with that directive.
std::optional<std::string_view> directive(std::string_view line, std::string_view word) {
  line = trimmed(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = trimmed(line.substr(1));
  if (!line.starts_with(word)) return std::nullopt;
  const std::string_view rest = line.substr(word.size());
  if (!rest.empty() && (std::isalnum(static_cast<unsigned char>(rest.front())) || rest.front() == '_'))
    return std::nullopt;
  return trimmed(rest);
}

/// The path of an include line, or nothing where it is not one path in double quotes.
std::optional<std::string> quoted(std::string_view text) {
  if (!text.starts_with('"')) return std::nullopt;
  const auto close = text.find('"', 1);
  if (close == std::string_view::npos || close == 1) return std::nullopt;
  const std::string_view rest = trimmed(text.substr(close + 1));
  if (!rest.empty() && !rest.starts_with("//")) return std::nullopt;
  return std::string(text.substr(1, close - 1));
}

/// Larger than any shader by far: keeps a wrong file from filling the memory.
constexpr std::uint64_t largest_shader_file = 4 << 20;
/// Includes inside each other. Those of the program are four deep.
constexpr std::size_t deepest_include = 32;

Result<std::string> read_shader_file(const std::string& file) {
  ASPIC_TRY(auto start, read_regular_file(file, largest_shader_file));
  if (start.size <= largest_shader_file) return std::move(start.content);
  return fail(ErrorCode::io, "The shader file {} is larger than 4 MiB.", printable_line(file));
}

/// shapes/all.glsl: the kernels of all terrain shapes, and the choice among them by terrains[t].shape. A
/// program leaves out those whose bits ASPIC_SHAPES lacks: some devices evaluate both sides of every branch.
std::string shape_choice() {
  std::string includes, distance, gap;
  for (const TerrainShapeRow& row : terrain_shapes) {
    const auto id = static_cast<unsigned>(row.value);
    includes += fmt::format("#include \"shapes/{}.glsl\"\n", row.kernel);
    constexpr std::string_view choice =
        "#if (ASPIC_SHAPES & {}) != 0\n  if (terrains[t].shape == {}u) return {}_{}(t, x);\n#endif\n";
    distance += fmt::format(choice, 1u << id, id, row.kernel, "distance");
    gap += fmt::format(choice, 1u << id, id, row.kernel, "gap");
  }
  return fmt::format(
      "#ifndef ASPIC_SHAPES\n#define ASPIC_SHAPES 0x7fffffff\n#endif\n{}\n"
      "// Signed distance [m], positive on the free side: the same bits as gap's.\n"
      "float distance_to(uint t, vec3 x) {{\n{}  return 0.0;\n}}\n\n"
      "// xyz: unit normal towards the free side; w: signed distance [m].\n"
      "vec4 gap(uint t, vec3 x) {{\n{}  return vec4(0.0);\n}}\n",
      includes, distance, gap);
}

}  // namespace

/// Whether `name` stands in `text` as a word.
bool mentions(std::string_view text, std::string_view name) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    if ((at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end]))) return true;
  }
  return false;
}

/// The defines that `text`, or one of these, mentions, in their order. Drivers keep programs by their text:
/// a define that nothing reads would have them compile the same program again.
std::vector<Define> used_of(std::span<const Define> defines, std::string_view text) {
  std::vector<bool> used(defines.size(), false);
  for (bool found = true; found;) {
    found = false;
    for (std::size_t i = 0; i < defines.size(); ++i) {
      const auto reads = [&](std::size_t other) {
        return used[other] && mentions(defines[other].value, defines[i].name);
      };
      bool read = mentions(text, defines[i].name);
      for (std::size_t other = 0; other < defines.size() && !read; ++other) read = reads(other);
      found = found || (read && !used[i]);
      used[i] = used[i] || read;
    }
  }
  std::vector<Define> kept;
  for (std::size_t i = 0; i < defines.size(); ++i)
    if (used[i]) kept.push_back(defines[i]);
  return kept;
}

/// A flattening under way: the shader so far, and the files that lead to the present one.
struct ShaderLibrary::Flattening {
  struct Open {
    int file;
    int line;
  };
  FlatShader shader;
  std::vector<Open> open;

  std::string chain() const {
    std::string text;
    for (const Open& o : open)
      text += fmt::format("{}{}:{}", text.empty() ? "" : " → ",
                          shader.files_[static_cast<std::size_t>(o.file)], o.line);
    return text;
  }
  void put(int file, int line, std::string_view text) {
    shader.text_ += text;
    shader.text_ += '\n';
    shader.lines_.push_back({file, line});
  }
};

Result<std::string> ShaderLibrary::read(std::string_view path) const {
  if (!directory_.empty()) {
    const std::filesystem::path file = directory_ / std::filesystem::path(path);
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return read_shader_file(file.string());
  }
  if (const auto text = find_embedded(embedded_shaders(), path)) return std::string(*text);
  if (path == "shapes/all.glsl") return shape_choice();
  if (path == "compute/lattice_links.glsl") return lattice_links();
  return fail(
      ErrorCode::io, "There is no shader file \"{}\"{}. Paths are relative to shaders/.", path,
      directory_.empty() ? " in the program" : fmt::format(" in {} or in the program", directory_.string()));
}

Result<FlatShader> ShaderLibrary::flatten(std::string_view path, std::span<const Define> defines) const {
  Flattening body;
  ASPIC_CHECK(append(body, std::string(path)));
  Flattening work;
  work.put(-1, 1, "#version 430 core");
  int line = 2;
  for (const Define& d : used_of(defines, body.shader.text_))
    work.put(-1, line++, fmt::format("#define {} {}", d.name, d.value));
  body.shader.text_.insert(0, work.shader.text_);
  body.shader.lines_.insert(body.shader.lines_.begin(), work.shader.lines_.begin(), work.shader.lines_.end());
  return std::move(body.shader);
}

Status ShaderLibrary::append(Flattening& work, const std::string& path) const {
  const auto where = [&] { return work.open.empty() ? std::string() : work.chain() + ": "; };
  auto& files = work.shader.files_;
  const auto seen = std::ranges::find(files, path);
  if (seen != files.end()) {
    const int file = static_cast<int>(seen - files.begin());
    if (std::ranges::any_of(work.open, [&](const auto& o) { return o.file == file; }))
      return fail(ErrorCode::io, "{}the include of \"{}\" closes a cycle. Remove one of these includes.",
                  where(), path);
    return {};
  }
  const Result<std::string> text = read(path);
  if (!text) return fail(text.error(), "{}{}", where(), text.error().what);

  if (work.open.size() == deepest_include) {
    return fail(ErrorCode::io,
                "{}:{}: includes are nested more than {} deep. Include the files from "
                "fewer levels.",
                files[static_cast<std::size_t>(work.open.back().file)], work.open.back().line,
                deepest_include);
  }
  const int file = static_cast<int>(files.size());
  files.push_back(path);
  work.open.push_back({file, 0});
  std::string_view rest = *text;
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    const int number = ++work.open.back().line;
    if (directive(line, "version"))
      return fail(ErrorCode::io, "{}: the program adds #version to every shader. Remove the line.",
                  work.chain());
    const auto include = directive(line, "include");
    if (!include) {
      work.put(file, number, line);
      continue;
    }
    const auto target = quoted(*include);
    if (!target)
      return fail(ErrorCode::io,
                  "{}: an include is written #include \"folder/file.glsl\", with a path "
                  "relative to shaders/.",
                  work.chain());
    ASPIC_CHECK(append(work, *target));
  }
  work.open.pop_back();
  return {};
}

Result<std::filesystem::path> shader_directory() {
  const char* value = std::getenv("ASPIC_SHADER_DIR");
  if (!value || !*value) return std::filesystem::path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(value, ignored)) {
    return fail(ErrorCode::io,
                "ASPIC_SHADER_DIR is {}, which is not a directory: use one laid out like shaders/ in the "
                "sources, or unset it.",
                printable_line(value));
  }
  return std::filesystem::path(value);
}

}  // namespace aspic::gl
