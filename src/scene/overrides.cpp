#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/printable.h"
#include "model/bodies.h"
#include "scene/parameters.h"
#include "scene/reader.h"

namespace aspic::overrides {
namespace {

using diagnostics::Position;
using diagnostics::Problem;
using reader::Reader;

/// One part of a key: `cube[0]` is name cube, index 0.
struct Segment {
  std::string name;
  std::optional<std::size_t> index;
  std::uint32_t column = 1;
};

std::uint32_t characters(std::string_view text) {
  return static_cast<std::uint32_t>(character_count(text));
}

bool is_bare_word(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (text.empty() || !letter(text.front())) return false;
  if (text == "true" || text == "false" || text == "nan" || text == "inf") return false;
  return std::all_of(text.begin(), text.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

/// One argument on its way into the scene.
class Argument {
 public:
  Argument(const std::string& text, std::uint32_t source, Reader& reader)
      : text_(text), source_(source), reader_(reader) {}

  void apply() {
    const std::size_t equals = text_.find('=');
    if (equals == std::string::npos) {
      return fail(1, "an argument of --set is KEY=VALUE, such as simulation.timestep=0.002");
    }
    if (!parse_key(std::string_view(text_).substr(0, equals))) return;
    if (!parse_value(equals)) return;
    read();
  }

 private:
  void fail(std::uint32_t column, std::string message) {
    reader_.fail({source_, 1, column}, std::move(message));
  }

  bool parse_key(std::string_view key) {
    while (!key.empty() && key.back() == ' ') key.remove_suffix(1);
    std::size_t start = 0;
    std::uint32_t column = 1;
    while (start <= key.size()) {
      const std::size_t end = std::min(key.find('.', start), key.size());
      const std::string_view part = key.substr(start, end - start);
      Segment segment;
      segment.column = column;
      segment.name = part.substr(0, part.find('['));
      if (const std::size_t bracket = part.find('['); bracket != std::string_view::npos) {
        const std::string_view digits = part.substr(bracket + 1);
        std::size_t index = 0;
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc() ||
            std::string_view(stop, static_cast<std::size_t>(digits.data() + digits.size() - stop)) != "]") {
          fail(segment.column + characters(part.substr(0, bracket)) + 1,
               "an index is a whole number from 0 in brackets, such as cube[0]");
          return false;
        }
        segment.index = index;
      }
      if (segment.name.empty()) {
        fail(segment.column, "a part of the key is missing here");
        return false;
      }
      segments_.push_back(segment);
      start = end + 1;
      column += characters(part) + 1;
    }
    return true;
  }

  bool parse_value(std::size_t equals) {
    const std::string_view value = std::string_view(text_).substr(equals + 1);
    const std::uint32_t column = characters(std::string_view(text_).substr(0, equals)) + 2;
    // A stand-in key of the same width keeps the parser's columns those of the argument.
    const std::string stand_in(std::max<std::size_t>(column - 2, 1), 'k');
    const char* const quote = is_bare_word(value) ? "\"" : "";
    auto parsed = document::parse(fmt::format("{0}={1}{2}{1}", stand_in, quote, value), source_);
    if (const auto* problem = std::get_if<Problem>(&parsed)) {
      fail(column, fmt::format("the value is neither a TOML value nor a single word; text with spaces needs "
                               "quotation marks inside the argument: '{}=\"…\"' ({})",
                               text_.substr(0, equals), problem->message));
      return false;
    }
    table_ = std::move(std::get<toml::table>(parsed));
    value_ = table_.get(stand_in);
    if (table_.size() != 1 || !value_) {
      fail(column, "the value ends with its first line");
      return false;
    }
    return true;
  }

  /// The key with `[0]` where a list lacks its index, for suggestions.
  std::string key_with_index(std::size_t list) const {
    std::string key;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      key += (s > 0 ? "." : "") + segments_[s].name;
      if (s == list) key += "[0]";
    }
    return key;
  }

  void read() {
    std::string table;
    std::size_t index = 0;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      const Segment& segment = segments_[s];
      const bool last = s + 1 == segments_.size();
      const std::string path = table + (table.empty() ? "" : ".") + segment.name;
      const Position at = {source_, 1, segment.column};
      const PathKind kind = path_kind(path);
      if (kind == PathKind::unknown)
        return fail(segment.column, diagnostics::unknown_key(table, segment.name));
      if (kind != PathKind::list && segment.index) {
        return fail(segment.column,
                    fmt::format("'{}' is not a list of tables and takes no index", segment.name));
      }
      if (kind == PathKind::parameter && !last) {
        return fail(segments_[s + 1].column, fmt::format("'{}' is a value and has no keys", segment.name));
      }
      if (kind == PathKind::list) {
        if (!find_element(segment, s)) return;
        index = *segment.index;
        table = path + "[]";
        if (!last) continue;
        if (const auto* values = value_->as_table())
          return reader_.read_table(*values, table, index, source_);
        return fail(
            document::position_of(value_->source(), source_).column,
            fmt::format("'{}' is a table: give {{ key = value }} or name one of its keys", segment.name));
      }
      if (last) return reader_.read_member(table, index, segment.name, at, *value_, source_);
      reader_.enter(path, index, at);
      table = path;
    }
  }

  bool find_element(const Segment& segment, std::size_t position) {
    const auto written = reader_.written().find(segment.name);
    if (written != reader_.written().end() && written->second.problem) return false;  // reported there
    const SettingsList& list = *std::ranges::find(settings_lists(), segment.name, &SettingsList::key);
    const std::size_t count = list.size(reader_.scene().model);
    if (!segment.index) {
      fail(segment.column, fmt::format("'{}' is a list and needs an index; did you mean '{}'?", segment.name,
                                       key_with_index(position)));
    } else if (*segment.index >= count) {
      fail(segment.column, count == 0   ? fmt::format("the scene has no [[{}]]", segment.name)
                           : count == 1 ? fmt::format("the scene has only one [[{0}]]: {0}[0]", segment.name)
                                        : fmt::format("the scene has {0} [[{1}]]: {1}[0] to {1}[{2}]", count,
                                                      segment.name, count - 1));
    } else {
      return true;
    }
    return false;
  }

  const std::string& text_;
  std::uint32_t source_;
  Reader& reader_;
  std::vector<Segment> segments_;
  toml::table table_;  // holds the value
  const toml::node* value_ = nullptr;
};

/// Where the first argument wrote the path or a value below it.
std::optional<Position> first_override(const Reader& reader, const std::string& path) {
  std::optional<Position> first;
  std::string at;
  for (const std::string& written : reader.written_in(path)) {
    const Position& key = reader.written().at(written).key;
    const bool deeper = first && key.source == first->source && written.starts_with(at);
    if (key.source == 0 || (first && key.source >= first->source && !deeper)) continue;
    first = key;
    at = written + ".";
  }
  return first;
}

/// Decides between material and explicit springs where arguments changed what the scene had chosen.
void resolve_material(Reader& reader, std::size_t cube, bool had_material) {
  const std::string material_path = path_text("cube[].material", cube);
  const auto written = reader.written().find(material_path);
  if (written != reader.written().end())
    had_material = written->second.key.source == 0;
  else if (!had_material)
    return;
  const std::optional<Position> set_material = first_override(reader, material_path);
  const std::vector<std::string> keys = reader.explicit_keys(cube);
  std::optional<Position> set_explicit;
  for (const std::string& key : keys) {
    const std::string path = fmt::format("cube[{}].{}", cube, key);
    if (had_material && reader.written().at(path).key.source == 0) return;  // the file is wrong by itself
    const auto at = first_override(reader, path);
    if (at && (!set_explicit || at->source < set_explicit->source)) set_explicit = at;
  }
  const bool all_set = std::ranges::all_of(parameters(), [&](const Parameter& p) {
    const auto place = reader.written().find(path_text(p.path, cube));
    return p.belonging != Belonging::explicit_springs ||
           (place != reader.written().end() && place->second.key.source > 0);
  });
  if (set_explicit && all_set && !set_material) {
    reader.scene().model.cubes[cube].material.reset();
    return reader.forget(material_path);
  }
  if (set_material && set_explicit) {
    reader.fail(std::max(*set_material, *set_explicit,
                         [](const Position& a, const Position& b) { return a.source < b.source; }),
                "a cube has either a material or masses and springs: --set gives both");
  } else if (set_explicit) {
    reader.fail(*set_explicit,
                "this cube is made of a material, which decides its masses and springs; set "
                "material.density, material.youngs-modulus or material.damping-ratio, or all of "
                "particle-mass, structural, shear and bending with stiffness and damping");
  } else if (!set_material) {
    return;
  }
  for (const std::string& key : keys) reader.forget(fmt::format("cube[{}].{}", cube, key));
}

/// Takes out the scene's geometry where an argument chose a shape that does not have it.
void resolve_shape(Reader& reader, std::size_t terrain) {
  const auto shape = reader.written().find(path_text("terrain[].shape", terrain));
  if (shape == reader.written().end() || shape->second.key.source == 0 || shape->second.problem) return;
  for (const Parameter& p : parameters()) {
    if (belongs_to_shape(p, reader.scene().model.terrain[terrain].shape)) continue;
    const std::string path = path_text(p.path, terrain);
    if (first_override(reader, path)) continue;
    p.clear(reader.scene(), terrain);
    reader.forget(path);
  }
}

}  // namespace

void apply(std::span<const std::string> arguments, Reader& reader,
           std::vector<diagnostics::Source>& sources) {
  const auto& cubes = reader.scene().model.cubes;
  std::vector<bool> had_material;
  for (const CubeSettings& cube : cubes) had_material.push_back(cube.material.has_value());
  for (const std::string& argument : arguments) {
    const auto source = static_cast<std::uint32_t>(sources.size());
    sources.push_back({"--set " + argument, argument, diagnostics::Source::argument});
    Argument(argument, source, reader).apply();
  }
  for (std::size_t c = 0; c < cubes.size(); ++c) resolve_material(reader, c, had_material[c]);
  for (std::size_t t = 0; t < reader.scene().model.terrain.size(); ++t) resolve_shape(reader, t);
}

}  // namespace aspic::overrides
