#include "scene/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <optional>
#include <vector>

#include "base/printable.h"
#include "model/bodies.h"

namespace aspic {
namespace {

std::string number_text(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string string_text(std::string_view s) {
  std::string text = "\"";
  while (!s.empty()) {
    const Utf8Character c = first_character(s);
    if (c.code == '"' || c.code == '\\') text += '\\';
    if (!c.valid) {
      text += "\\uFFFD";  // no scene that was read has such bytes, but a file's name may
    } else if (acts_on_terminal(c.code)) {
      text += fmt::format("\\u{:04X}", c.code);
    } else {
      text += s.substr(0, c.size);
    }
    s.remove_prefix(c.size);
  }
  return text + "\"";
}

/// A key of a table as TOML writes it.
std::string key_of_table(const std::string& key) {
  const bool bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? key : string_text(key);
}

struct Writer {
  std::string operator()(std::integral auto x) const { return fmt::format("{}", x); }
  std::string operator()(double x) const { return number_text(x); }
  std::string operator()(const std::string& x) const { return string_text(x); }
  std::string operator()(const Vec3& x) const {
    return fmt::format("[{}, {}, {}]", number_text(x.x), number_text(x.y), number_text(x.z));
  }
  template <class T>
  std::string operator()(const std::vector<T>& x) const {
    std::vector<std::string> all;
    for (const T& element : x) all.push_back((*this)(element));
    return fmt::format("[{}]", fmt::join(all, ", "));
  }
  std::string operator()(const std::array<double, 2>& x) const {
    return fmt::format("[{}, {}]", number_text(x[0]), number_text(x[1]));
  }
  std::string operator()(const CellPalette& x) const {
    std::vector<std::string> all;
    for (const auto& [cell, name] : x)
      all.push_back(fmt::format("{} = {}", key_of_table(cell), string_text(name)));
    return all.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(all, ", "));
  }
  std::string operator()(const PinnedSettings& x) const {
    std::vector<std::string> all;
    for (const std::string& name : x.names) all.push_back(string_text(name));
    for (const std::int64_t index : x.indices) all.push_back(fmt::format("{}", index));
    return fmt::format("[{}]", fmt::join(all, ", "));
  }
};

/// Layers one above the other, with a line for each row.
std::string rows_text(const CellLayers& layers) {
  std::string text = "[";
  for (const auto& layer : layers) {
    text += "\n  [";
    for (const std::string& row : layer)
      text += fmt::format("{}{}", &row == &layer.front() ? "" : ",\n   ", string_text(row));
    text += "],";
  }
  return text + "\n]";
}

/// Layers on a line each, or several small ones on one.
std::string layers_text(const CellLayers& layers) {
  const std::string one_line = Writer()(layers);
  if (one_line.size() < 80) return one_line;
  std::string text = "[";
  for (const auto& layer : layers) text += fmt::format("\n  {},", Writer()(layer));
  return text + "\n]";
}

/// A text without blanks and escapes, on as many lines as it takes.
std::string wrapped_text(const std::string& text) {
  constexpr std::size_t width = 120;
  if (text.size() < width) return Writer()(text);
  std::string lines = "\"\"\"";
  for (std::size_t at = 0; at < text.size(); at += width) lines += "\n" + text.substr(at, width);
  return lines + "\"\"\"";
}

/// One name alone where there is one.
std::string names_text(const Value& value) {
  const auto& names = std::get<std::vector<std::string>>(value);
  return names.size() == 1 ? Writer()(names.front()) : Writer()(names);
}

/// An inline table; of a material that has a name, the name alone.
std::string inline_text(std::string_view name, std::string_view keys) {
  constexpr std::string_view named = "name = ";
  if (name == "material" && keys.starts_with(named))
    return fmt::format("{} = {}", name, keys.substr(named.size()));
  // A phase that is the same everywhere is a number.
  constexpr std::string_view offset = "offset = ", everywhere = ", along = \"none\"";
  if (name == "phase" && keys.starts_with(offset) && keys.ends_with(everywhere))
    return fmt::format("{} = {}", name,
                       keys.substr(offset.size(), keys.size() - offset.size() - everywhere.size()));
  return fmt::format("{} = {{ {} }}", name, keys);
}

/// A line of the file: its text, and the comment behind it.
struct Line {
  std::string text, comment;
};

/// How a scene is written.
struct Manner {
  /// Of a short file what is known of the scene before a key is written: it takes what is, and keys that say
  /// nothing new are left out. Null: every key is written.
  Scene* known = nullptr;
};

/// Keys that a person writes whatever their value: the format's version, the name, which would be the file's,
/// and what a body of cells is.
bool says_what_it_is(const Parameter& p) {
  return p.path == "schema" || p.path == "name" || p.type == ParameterType::layers;
}

/// What reading would make of the bodies where a file has neither.
bool is_aim(const Parameter& p) {
  return p.path == "view.camera.position" || p.path == "view.camera.target";
}

/// A value of a key of the scene.
std::string value_text(const Parameter& p, const Value& value, const Manner& manner) {
  if (p.type == ParameterType::layers) {
    const auto& layers = std::get<CellLayers>(value);
    return manner.known ? rows_text(layers) : layers_text(layers);
  }
  if (p.type == ParameterType::names) return names_text(value);
  return p.path == "voxels[].skin" ? wrapped_text(std::get<std::string>(value)) : toml_value(value);
}

/// Lines of one table; `prefix` is its path with a dot ("" for the head of the file). Keys one level deeper
/// are gathered into inline tables.
std::vector<Line> lines_of(const Scene& scene, std::string_view prefix, std::size_t index,
                           const Manner& manner) {
  struct Inline {
    std::string_view name;
    std::string text, comment;
  };
  std::vector<Line> lines;
  std::vector<Inline> open;
  const auto close = [&] {
    for (const Inline& t : open) lines.push_back({inline_text(t.name, t.text), t.comment});
    open.clear();
  };
  for (const Parameter& p : parameters()) {
    if (!p.path.starts_with(prefix) || (prefix.empty() && !p.section().empty())) continue;
    const std::string_view rest = p.path.substr(prefix.size());
    const std::size_t dot = rest.find('.');
    const std::string_view head = rest.substr(0, dot);
    if (!open.empty() && open.back().name != head) close();
    const auto value = p.get(scene, index);
    if (!value) {
      // Written as a comment, so that the file shows every key there is.
      if (!manner.known && dot == std::string_view::npos && applies(p, scene, index)) {
        lines.push_back({fmt::format("# {}: {}", rest, p.when_absent), ""});
      }
      continue;
    }
    if (manner.known && is_aim(p) && scene.view.aimed) continue;
    if (manner.known && !is_aim(p) && !says_what_it_is(p)) {
      // By their texts, which tell -0 from 0.
      const auto known = p.get(*manner.known, index);
      if (known && toml_value(*known) == toml_value(*value)) continue;
      p.set(*manner.known, index, *value);
    }
    const std::string text = value_text(p, *value, manner);
    if (dot == std::string_view::npos) {
      std::string comment(p.unit);
      if (p.type == ParameterType::word && !manner.known)
        comment = fmt::format("{}", fmt::join(p.words, " | "));
      lines.push_back({fmt::format("{} = {}", rest, text), comment});
      continue;
    }
    if (open.empty()) open.push_back({head, "", ""});
    Inline& table = open.back();
    table.text += fmt::format("{}{} = {}", table.text.empty() ? "" : ", ", rest.substr(dot + 1), text);
    if (!p.unit.empty()) table.comment += fmt::format("{}{}", table.comment.empty() ? "" : ", ", p.unit);
  }
  close();
  return lines;
}

/// Lines with their comments in one column, as far as lines are short enough.
std::string aligned(const std::vector<Line>& lines) {
  constexpr std::size_t widest = 54;
  std::size_t column = 0;
  for (const Line& line : lines) {
    if (!line.comment.empty() && line.text.size() <= widest) column = std::max(column, line.text.size());
  }
  std::string text;
  for (const Line& line : lines) {
    text += line.text;
    if (!line.comment.empty()) {
      text +=
          std::string(line.text.size() < column ? column - line.text.size() : 0, ' ') + "  # " + line.comment;
    }
    text += '\n';
  }
  return text;
}

/// Materials in a table by name, a line each. Nothing where that would not read as the same list: some have
/// no name, or they are not in the order of names, in which tables are read.
std::optional<std::string> material_table(const Scene& scene) {
  const auto& materials = scene.model.materials;
  if (!std::ranges::is_sorted(materials, {}, &MaterialSettings::name) || materials.empty() ||
      materials.front().name.empty())
    return std::nullopt;
  std::vector<Line> lines;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::string keys;
    for (const Parameter& p : parameters())
      if (p.section() == "material[]" && p.key() != "name")
        keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", p.key(), toml_value(*p.get(scene, i)));
    lines.push_back({fmt::format("{} = {{ {} }}", key_of_table(materials[i].name), keys), ""});
  }
  return "\n[material]\n" + aligned(lines);
}

std::string written(const Scene& scene, const Manner& manner) {
  std::string text = aligned(lines_of(scene, "", 0, manner));
  std::vector<std::string_view> done;
  for (const Parameter& p : parameters()) {
    const std::string_view section = p.section();
    if (section.empty() || std::ranges::find(done, section) != done.end()) continue;
    done.push_back(section);
    if (const auto table = manner.known && section == "material[]" ? material_table(scene) : std::nullopt) {
      text += *table;
      continue;
    }
    const bool list = section.ends_with("[]");
    for (std::size_t i = 0; i < index_count(p, scene); ++i) {
      const std::vector<Line> lines = lines_of(scene, fmt::format("{}.", section), i, manner);
      if (lines.empty() && !list && manner.known) continue;
      text += list ? fmt::format("\n[[{}]]\n", section.substr(0, section.size() - 2))
                   : fmt::format("\n[{}]\n", section);
      text += aligned(lines);
    }
  }
  return text;
}

}  // namespace

std::string toml_value(const Value& value) {
  return std::visit(Writer{}, value);
}

std::string to_toml(const Scene& scene) {
  return written(scene, {});
}

std::string to_short_toml(const Scene& scene) {
  Scene known;
  for (const SettingsList& list : settings_lists())
    while (list.size(known.model) < list.size(scene.model)) list.append(known.model);
  return written(scene, {&known});
}

}  // namespace aspic
