#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "base/printable.h"
#include "model/bodies.h"
#include "scene/parameters.h"
#include "scene/reader.h"
#include "scene/short_keys.h"

namespace aspic::overrides {
namespace {

using diagnostics::Position;
using diagnostics::Problem;
using reader::Reader;

/// One part of a key: `cube[0]` is name cube, index 0; `material[fat]` the material of that name; `cube[+]` a
/// further cube.
struct Segment {
  std::string name;
  std::optional<std::size_t> index;
  std::uint32_t column = 1;
  std::string element = {};  ///< a name in the place of the index
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

/// Of a key whose values are text: what may be a number elsewhere is a word here, such as a student's number;
/// and a name may have letters of any language, hyphens and full stops.
bool is_word_of_text(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
  };
  const bool name = !text.empty() && letter(text.front());
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '_' || (name && (c == '-' || c == '.'));
  });
}

/// A number as people write it with a comma, or with its unit.
struct MistakenNumber {
  std::string number;     ///< as it is meant
  std::string_view rest;  ///< what follows it, the unit
};
std::optional<MistakenNumber> mistaken_number(std::string_view text) {
  const auto digits_from = [&](std::size_t at) {
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at;
  };
  const std::size_t start = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  std::size_t end = digits_from(start);
  if (end == start) return std::nullopt;
  if (end < text.size() && (text[end] == '.' || text[end] == ',')) end = digits_from(end + 1);
  if (end + 1 < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t exponent = end + (text[end + 1] == '-' || text[end + 1] == '+' ? 2 : 1);
    if (digits_from(exponent) > exponent) end = digits_from(exponent);
  }
  MistakenNumber found = {std::string(text.substr(0, end)), text.substr(end)};
  std::ranges::replace(found.number, ',', '.');
  while (found.rest.starts_with(' ')) found.rest.remove_prefix(1);
  return found;
}

/// What to write instead of a value that is no TOML, where it looks like a number, a list or a unit. Empty:
/// it looks like none of them. `unit`: of the key's numbers; empty: none, or the key is not known.
std::string advice_on(std::string_view value, std::string_view unit) {
  if (std::ranges::count(value, ',') > 0 &&
      value.find_first_not_of("0123456789+-.,eE ") == std::string_view::npos) {
    const auto one = mistaken_number(value);
    if (one && one->rest.empty() && std::ranges::count(value, ',') == 1 &&
        value.find('.') == std::string_view::npos)
      return fmt::format("numbers have a decimal point, {}; a list needs brackets, [{}]", one->number, value);
    return fmt::format("a list needs brackets, [{}]", value);
  }
  const auto number = mistaken_number(value);
  if (!number || number->rest.empty()) return "";
  if (number->rest == "%") {
    double percent = 0.0;
    const auto [end, error] =
        std::from_chars(number->number.data(), number->number.data() + number->number.size(), percent);
    return error == std::errc() ? fmt::format("write {:.6g} for {}", percent / 100.0, value) : "";
  }
  if (number->rest.find_first_of("0123456789\"'[]{}=") != std::string_view::npos) return "";
  return unit.empty() ? fmt::format("write the number alone, {}", number->number)
                      : fmt::format("write the number alone, in {}", unit);
}

/// What arguments are about.
struct Keys {
  std::string_view table;  ///< that the keys are in; empty: the scene itself
  std::string_view example;
};
constexpr Keys of_scene = {"", "simulation.timestep=0.002"}, of_view = {"view", "color=strain"};

/// One argument on its way into the scene.
class Argument {
 public:
  Argument(const Keys& keys, const std::string& text, std::uint32_t source, Reader& reader)
      : keys_(keys), text_(text), source_(source), reader_(reader) {}

  void apply() {
    const std::size_t equals = text_.find('=');
    if (equals == std::string::npos) {
      return fail(1, fmt::format("an argument is KEY=VALUE, such as {}", keys_.example));
    }
    if (!keys_.table.empty()) segments_.push_back({std::string(keys_.table), {}, 1});
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
        const std::string_view rest(stop, static_cast<std::size_t>(digits.data() + digits.size() - stop));
        if (error == std::errc::invalid_argument && digits.size() > 1 && digits.ends_with(']')) {
          segment.element = digits.substr(0, digits.size() - 1);
        } else if (error != std::errc() || rest != "]") {
          fail(segment.column + characters(part.substr(0, bracket)) + 1,
               "an index is an integer from 0 in brackets, such as cube[0]");
          return false;
        } else {
          segment.index = index;
        }
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
    const Parameter* const parameter = find_parameter(parameter_path());
    const bool takes_text = parameter && parameter->type == ParameterType::text;
    const char* const quote = is_bare_word(value) || (takes_text && is_word_of_text(value)) ? "\"" : "";
    auto parsed = document::parse(fmt::format("{0}={1}{2}{1}", stand_in, quote, value), source_);
    if (const auto* problem = std::get_if<Problem>(&parsed)) {
      if (const std::string advice = takes_text ? "" : advice_on(value, parameter ? parameter->unit : "");
          !advice.empty())
        fail(column, advice);
      else
        fail(column, fmt::format("the value is neither a TOML value nor a single word; text with spaces "
                                 "needs quotation marks inside the argument: '{}=\"…\"' ({})",
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

  /// The key as the parameter table has it: `cube[].shear.stiffness`.
  std::string parameter_path() const {
    std::string path;
    for (const Segment& segment : segments_)
      path += fmt::format("{}{}{}", path.empty() ? "" : ".", segment.name,
                          segment.index || !segment.element.empty() ? "[]" : "");
    return path;
  }

  /// The key with an index where a list lacks it, for suggestions: `cube[0].…` for `cube.…` and `cube.0.…`.
  std::string key_with_index(std::size_t list) const {
    std::string key;
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      key += (s > 0 ? "." : "") + segments_[s].name;
      if (s != list) continue;
      const bool number = s + 1 < segments_.size() &&
                          segments_[s + 1].name.find_first_not_of("0123456789") == std::string::npos;
      key += fmt::format("[{}]", number ? segments_[++s].name : "0");
    }
    return key;
  }

  /// The message for a key that the table `path` does not have.
  std::string unknown_key(const std::string& path, const std::string& name) const {
    if (!path.empty()) return diagnostics::unknown_key(path, name);
    if (const ShortKey* const row = segments_.size() == 1 ? find_short_key(name) : nullptr) {
      const auto targets = row->targets(reader_.scene());
      return fmt::format("'{}' is a short name for comparisons and sweeps; use a scene key here{}", name,
                         targets.empty() ? "" : fmt::format(", such as '{}'", targets.front().path));
    }
    // The end of a key alone, `shear.stiffness`.
    const std::string ending = "." + parameter_path();
    std::vector<std::string> whole;
    for (const Parameter& p : parameters())
      if (segments_.size() > 1 && p.path.ends_with(ending)) whole.push_back(path_text(p.path, 0));
    if (whole.empty()) return diagnostics::unknown_key(path, name);
    const std::vector<std::string_view> names(
        whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(whole.size(), 4)));
    return fmt::format("unknown key '{}'; did you mean {}?", text_.substr(0, text_.find('=')),
                       diagnostics::list_text(names, false));
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
      if (kind == PathKind::unknown) return fail(segment.column, unknown_key(table, segment.name));
      if (kind != PathKind::list && (segment.index || !segment.element.empty())) {
        return fail(segment.column,
                    fmt::format("'{}' is not a list of tables and takes no index", segment.name));
      }
      if (kind == PathKind::parameter && !last) {
        return fail(segments_[s + 1].column, fmt::format("'{}' is a value and has no keys", segment.name));
      }
      if (kind == PathKind::list) {
        const auto element = find_element(segment, s);
        if (!element) return;
        index = *element;
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

  std::optional<std::size_t> find_element(const Segment& segment, std::size_t position) {
    const auto written = reader_.written().find(segment.name);
    if (written != reader_.written().end() && written->second.problem) return {};  // reported there
    const SettingsList& list = *std::ranges::find(settings_lists(), segment.name, &SettingsList::key);
    const std::size_t count = list.size(reader_.scene().model);
    if (segment.element == "+") return further_element(list, segment);
    if (!segment.element.empty()) return named_element(segment);
    if (!segment.index) {
      fail(segment.column, fmt::format("'{}' is a list and needs an index; did you mean '{}'?", segment.name,
                                       key_with_index(position)));
    } else if (*segment.index >= count) {
      fail(segment.column, count == 0   ? fmt::format("the scene has no [[{}]]", segment.name)
                           : count == 1 ? fmt::format("the scene has only one [[{0}]]: {0}[0]", segment.name)
                                        : fmt::format("the scene has {0} [[{1}]]: {1}[0] to {1}[{2}]", count,
                                                      segment.name, count - 1));
    } else {
      return segment.index;
    }
    return {};
  }

  /// A new element at the end of the list, with default values.
  std::size_t further_element(const SettingsList& list, const Segment& segment) {
    const std::size_t index = list.size(reader_.scene().model);
    list.append(reader_.scene().model);
    reader_.enter(fmt::format("{}[]", list.key), index, {source_, 1, segment.column});
    return index;
  }

  std::optional<std::size_t> named_element(const Segment& segment) {
    const auto index = element_named(reader_.scene(), segment.name, segment.element);
    if (index) return index;
    const std::vector<std::string> names = element_names(reader_.scene(), segment.name);
    const std::vector<std::string_view> known(names.begin(), names.end());
    const std::uint32_t at = segment.column + characters(segment.name) + 1;
    if (known.empty())
      fail(at, "an index is an integer from 0 in brackets, such as cube[0]");
    else
      fail(at, fmt::format("the scene has no {} of that name; it has {}{}", segment.name,
                           diagnostics::list_text(known, false),
                           diagnostics::did_you_mean(diagnostics::nearest(segment.element, known))));
    return {};
  }

  const Keys& keys_;
  const std::string& text_;
  std::uint32_t source_;
  Reader& reader_;
  std::vector<Segment> segments_;
  toml::table table_;  // holds the value
  const toml::node* value_ = nullptr;
};

/// Keys of an actuator of which it has one or the other.
constexpr std::pair<std::string_view, std::string_view> exclusive_actuator_keys[] = {
    {"actuator[].amplitude", "actuator[].volume-change"},
    {"actuator[].phase.cells", "actuator[].phase.file"},
    {"actuator[].select.voxels", "actuator[].select.file"}};

void apply_to(const Keys& keys, const Arguments& arguments, Reader& reader,
              std::vector<diagnostics::Source>& sources) {
  const auto& cubes = reader.scene().model.cubes;
  std::vector<std::pair<BodyInList, bool>> had_material;
  for (const SettingsList& list : settings_lists()) {
    const std::string section = fmt::format("{}[]", list.key);
    for (std::size_t i = 0; i < list.size(reader.scene().model); ++i)
      if (const auto* const material = material_place(reader.scene().model, section, i))
        had_material.push_back({{list.key, i}, material->has_value()});
  }
  for (const std::string& argument : arguments.texts) {
    const auto source = static_cast<std::uint32_t>(sources.size());
    const std::string& origin = arguments.origin;
    sources.push_back({origin.empty() ? argument : fmt::format("{} {}", origin, argument), argument,
                       diagnostics::Source::argument});
    Argument(keys, argument, source, reader).apply();
  }
  for (const auto& [body, had] : had_material) resolve_material(reader, body, had);
  for (std::size_t v = 0; v < reader.scene().model.voxels.size(); ++v) {
    reader.prefer_argument(path_text("voxels[].file", v), path_text("voxels[].layers", v));
    reader.prefer_argument(path_text("voxels[].layers", v), path_text("voxels[].file", v));
    for (const std::string_view other :
         {"voxels[].layers", "voxels[].file", "voxels[].size", "voxels[].skin"}) {
      reader.prefer_argument(path_text("voxels[].mesh", v), path_text(other, v));
      reader.prefer_argument(path_text(other, v), path_text("voxels[].mesh", v));
    }
  }
  for (std::size_t a = 0; a < reader.scene().model.actuators.size(); ++a) {
    for (const auto& [one, other] : exclusive_actuator_keys) {
      reader.prefer_argument(path_text(one, a), path_text(other, a));
      reader.prefer_argument(path_text(other, a), path_text(one, a));
    }
  }
  for (std::size_t c = 0; c < cubes.size(); ++c) {
    reader.prefer_argument(path_text("cube[].particles", c), path_text("cube[].particles-per-edge", c));
    reader.prefer_argument(path_text("cube[].particles-per-edge", c), path_text("cube[].particles", c));
  }
  for (std::size_t t = 0; t < reader.scene().model.terrain.size(); ++t) resolve_shape(reader, t);
}

}  // namespace

void apply(const Arguments& arguments, Reader& reader, std::vector<diagnostics::Source>& sources) {
  apply_to(of_scene, arguments, reader, sources);
}

void apply_view(const Arguments& arguments, Reader& reader, std::vector<diagnostics::Source>& sources) {
  apply_to(of_view, arguments, reader, sources);
}

}  // namespace aspic::overrides
