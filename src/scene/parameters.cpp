#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/bodies.h"
#include "model/terrain.h"
#include "scene/diagnostics.h"
#include "scene/write.h"

namespace aspic {
namespace {

/// Shorter directions lose their digits when their length is squared.
constexpr double shortest_direction = 1e-100;

/// The shape's key behind a row of the table; nullptr if the shape does not have it.
const GeometryKey* geometry_key(const Parameter& p, TerrainShape shape) {
  return aspic::geometry_key(shape, p.key());
}

/// The list an indexed path leads into, or nullptr.
const SettingsList* list_of(std::string_view path) {
  const std::string_view key = path.substr(0, path.find('['));
  const auto found = std::ranges::find(settings_lists(), key, &SettingsList::key);
  return key.size() == path.size() || found == settings_lists().end() ? nullptr : &*found;
}

std::string range_text(const Parameter& p) {
  // Large ends are powers of ten: 1e6 reads better than 1000000.
  const auto figure = [](double x) {
    if (std::abs(x) < 1e6) return fmt::format("{}", x);
    return fmt::format("{}1e{}", x < 0.0 ? "-" : "", std::lround(std::log10(std::abs(x))));
  };
  const std::string unit = p.unit.empty() ? "" : fmt::format(" {}", p.unit);
  const Range& r = p.range;
  if (r.min == r.max) return figure(r.min);
  if (r.min_excluded) return fmt::format("> {} and ≤ {}{}", figure(r.min), figure(r.max), unit);
  return fmt::format("{} … {}{}", figure(r.min), figure(r.max), unit);
}

std::optional<std::string> complaint_about(const Parameter& p, double value) {
  if (!std::isfinite(value)) {
    const char* hint = p.when_absent == "infinite" ? "; omit the key for an infinite one" : "";
    return fmt::format("'{}' must be finite, not {}{}; allowed: {}", key_text(p), value, hint,
                       allowed_text(p));
  }
  const Range& r = p.range;
  if (value < r.min || value > r.max || (r.min_excluded && value == r.min)) {
    if (p.path == "schema") {
      return fmt::format("unknown schema version {}; this version of Aspic reads schema = {}", value,
                         scene_schema);
    }
    return fmt::format("'{}' is out of range: {}; allowed: {}", key_text(p), value, allowed_text(p));
  }
  // The default precision is single: a value that is positive here must be so there.
  if (r.min_excluded && static_cast<float>(value) <= static_cast<float>(r.min)) {
    return fmt::format("'{}' is out of range: {} is zero in single precision; allowed: {}", key_text(p),
                       value, allowed_text(p));
  }
  return std::nullopt;
}

std::optional<std::string> complaint_about_word(const Parameter& p, const std::string& word) {
  const bool known = std::ranges::find(p.words, word) != p.words.end();
  if (known || (p.pins && p.pins->knows(word))) return std::nullopt;
  return fmt::format("'{}' has the unknown value \"{}\"; allowed: {}{}", key_text(p), word, allowed_text(p),
                     diagnostics::did_you_mean(diagnostics::nearest(word, p.words)));
}

/// What a value holds of numbers. Each return makes its own vector: g++ 14 warns where one takes on a value
/// of three numbers after one of one (-Warray-bounds).
std::vector<double> numbers_of(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return {static_cast<double>(*whole)};
  if (const auto* number = std::get_if<double>(&value)) return {*number};
  if (const auto* v = std::get_if<Vec3>(&value)) return {v->x, v->y, v->z};
  if (const auto* counts = std::get_if<std::vector<int>>(&value)) return {counts->begin(), counts->end()};
  if (const auto* several = std::get_if<std::vector<double>>(&value)) return *several;
  if (const auto* points = std::get_if<SignalTable>(&value)) {
    std::vector<double> all;
    for (const auto& [t, w] : *points) all.insert(all.end(), {t, w});
    return all;
  }
  return {};
}

}  // namespace

std::optional<Value> Parameter::get(const Scene& scene, std::size_t index) const {
  if (!applies(*this, scene, index)) return std::nullopt;
  std::optional<Value> value = read(*this, scene, index);
  if (!value && belonging == Belonging::geometry)
    return as_value(geometry_key(*this, scene.model.terrain[index].shape)->value);
  return value;
}

const FormerKey* find_former_key(std::string_view path) {
  static const FormerKey table[] = {{"contact.epsilon", {"contact.distance", "contact.resting-speed"}},
                                    {"terrain[].centre", {"terrain[].center"}},
                                    {"view.colour", {"view.color"}}};
  const auto* const found = std::ranges::find(table, path, &FormerKey::path);
  return found == std::end(table) ? nullptr : found;
}

std::string_view present_word(std::string_view path, std::string_view word) {
  return path == "view.scale.map" && word == "grey" ? "gray" : word;
}

const Parameter* find_parameter(std::string_view path) {
  if (const FormerKey* const former = find_former_key(path)) path = former->successors.front();
  const auto all = parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.path == path; });
  return found == all.end() ? nullptr : &*found;
}

std::string key_text(const Parameter& parameter) {
  std::string text(parameter.path);
  if (const std::size_t brackets = text.find("[]"); brackets != std::string::npos) text.erase(brackets, 2);
  return text;
}

std::string path_text(std::string_view path, std::size_t index) {
  std::string text(path);
  if (const std::size_t at = text.find("[]"); at != std::string::npos)
    text.replace(at, 2, fmt::format("[{}]", index));
  return text;
}

PathKind path_kind(std::string_view path) {
  if (find_former_key(path)) return PathKind::parameter;
  for (const Parameter& p : parameters()) {
    if (p.path == path) return PathKind::parameter;
    if (!p.path.starts_with(path)) continue;
    const std::string_view rest = p.path.substr(path.size());
    if (path.empty() || rest.starts_with('.')) return PathKind::table;
    if (rest.starts_with("[]")) return PathKind::list;
  }
  return PathKind::unknown;
}

std::vector<std::string_view> child_keys(std::string_view table_path) {
  std::vector<std::string_view> keys;
  for (const Parameter& p : parameters()) {
    std::string_view rest = p.path;
    if (!table_path.empty()) {
      if (!rest.starts_with(table_path) || !rest.substr(table_path.size()).starts_with('.')) continue;
      rest.remove_prefix(table_path.size() + 1);
    }
    const std::string_view key = rest.substr(0, rest.find_first_of(".["));
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

bool applies(const Parameter& parameter, const Scene& scene, std::size_t index) {
  switch (parameter.belonging) {
    case Belonging::always:
      return true;
    case Belonging::geometry:
      return belongs_to_shape(parameter, scene.model.terrain[index].shape);
    case Belonging::motion:
      return scene.model.terrain[index].motion.has_value();
    case Belonging::explicit_springs:
      return !made_of(scene.model, parameter.section(), index);
    case Belonging::material:
      return made_of(scene.model, parameter.section(), index);
    case Belonging::material_numbers:
    case Belonging::material_name: {
      const MaterialSettings* const material = made_of(scene.model, parameter.section(), index);
      return material && material->name.empty() == (parameter.belonging == Belonging::material_numbers);
    }
    case Belonging::equal_edges:
      return !scene.model.cubes[index].particles.has_value();
    case Belonging::box:
      return scene.model.cubes[index].particles.has_value();
    case Belonging::amplitude:
      return !scene.model.actuators[index].volume_change.has_value();
    case Belonging::wave:
      return scene.model.actuators[index].phase.along != BodyAxis::none;
    case Belonging::signal_table:
      return scene.model.actuators[index].signal == Signal::table;
  }
  return false;
}

std::optional<MaterialSettings>* material_place(ModelSettings& settings, std::string_view section,
                                                std::size_t index) {
  if (section == "cube[]") return &settings.cubes[index].material;
  if (section == "cloth[]") return &settings.cloths[index].material;
  if (section == "goal-net[]") return &settings.goal_nets[index].material;
  return nullptr;
}

const MaterialSettings* made_of(const ModelSettings& settings, std::string_view section, std::size_t index) {
  const auto pointer = [](const std::optional<MaterialSettings>& material) {
    return material ? &*material : nullptr;
  };
  if (section == "cube[]") return pointer(settings.cubes[index].material);
  if (section == "cloth[]") return pointer(settings.cloths[index].material);
  if (section == "goal-net[]") return pointer(settings.goal_nets[index].material);
  if (section == "voxels[]" && settings.voxels[index].palette.empty())
    return &settings.voxels[index].material;
  return nullptr;
}

bool belongs_to_shape(const Parameter& parameter, TerrainShape shape) {
  return parameter.belonging != Belonging::geometry || geometry_key(parameter, shape) != nullptr;
}

std::size_t index_count(const Parameter& parameter, const Scene& scene) {
  const SettingsList* list = list_of(parameter.path);
  return list ? list->size(scene.model) : 1;
}

namespace {

/// The name of each element of a list, empty where it has none; no element where the list has no names.
std::vector<std::string> names_of(const Scene& scene, std::string_view list) {
  std::vector<std::string> names;
  const Parameter* const p = find_parameter(fmt::format("{}[].name", list));
  for (std::size_t i = 0; p && i < index_count(*p, scene); ++i)
    names.push_back(std::get<std::string>(p->get(scene, i).value_or(Value(std::string()))));
  return names;
}

}  // namespace

std::vector<std::string> element_names(const Scene& scene, std::string_view list) {
  std::vector<std::string> names = names_of(scene, list);
  std::erase(names, "");
  return names;
}

std::optional<std::size_t> element_named(const Scene& scene, std::string_view list, std::string_view name) {
  const std::vector<std::string> names = names_of(scene, list);
  const auto found = std::ranges::find(names, name);
  if (name.empty() || found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::optional<Complaint> check_value(const Parameter& p, const Value& value) {
  const std::vector<double> numbers = numbers_of(value);
  std::vector<std::string> words;
  if (p.type == ParameterType::word) words = {std::get<std::string>(value)};
  if (const auto* list = std::get_if<std::vector<std::string>>(&value);
      list && p.type == ParameterType::words)
    words = *list;
  if (const auto* pinned = std::get_if<PinnedSettings>(&value)) words = pinned->names;
  const bool several = !std::holds_alternative<std::string>(value) && numbers.size() != 1;
  // Two numbers are a point.
  const std::size_t together = p.type == ParameterType::points ? 2 : 1;
  const auto at = [&](std::size_t i) { return several ? std::optional(i / together) : std::nullopt; };

  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (auto message = complaint_about(p, numbers[i])) return Complaint{*message, at(i)};
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (auto message = complaint_about_word(p, words[i])) return Complaint{*message, at(i)};
    const bool twice = std::find(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(i), words[i]) !=
                       words.begin() + static_cast<std::ptrdiff_t>(i);
    if (twice && p.type == ParameterType::words)
      return Complaint{fmt::format("'{}' names \"{}\" twice", key_text(p), words[i]), i};
  }
  if (p.direction && length(std::get<Vec3>(value)) < shortest_direction) {
    return Complaint{
        fmt::format("'{}' has no direction: its length is zero; allowed: {}", key_text(p), allowed_text(p)),
        std::nullopt};
  }
  return std::nullopt;
}

std::string allowed_text(const Parameter& p) {
  switch (p.type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return fmt::format("an integer, {}", range_text(p));
    case ParameterType::number:
      return fmt::format("a number {}", range_text(p));
    case ParameterType::text:
      return "a string";
    case ParameterType::word:
      return diagnostics::list_text(p.words, true);
    case ParameterType::words:
      return fmt::format("an array of {}, each at most once", diagnostics::list_text(p.words, true));
    case ParameterType::vector:
      return fmt::format("three numbers [x, y, z], each {}{}", range_text(p),
                         p.direction ? ", not all zero" : "");
    case ParameterType::counts:
    case ParameterType::numbers:
      return fmt::format("{} {} [along x, y{}], each {}", p.components == 2 ? "two" : "three",
                         p.type == ParameterType::counts ? "integers" : "numbers",
                         p.components == 2 ? "" : ", z", range_text(p));
    case ParameterType::pinned:
      return fmt::format("an array of {}s ({}), corners ({}) and local indices 0 … {}", p.pins->side,
                         diagnostics::list_text(p.words, false), p.pins->corner, p.pins->last_index);
    case ParameterType::layers:
      return "an array of layers, each an array of rows, which are strings of cells";
    case ParameterType::palette:
      return "a table of materials' names by cell, such as { 1 = \"muscle\" }";
    case ParameterType::names:
      return "a string, or an array of strings";
    case ParameterType::points:
      return fmt::format("an array of points [t, w], each {}", range_text(p));
  }
  return "";
}

std::string default_text(const Parameter& p) {
  if (p.belonging == Belonging::geometry) {
    std::string text;
    for (const TerrainShapeRow& row : terrain_shapes) {
      if (const GeometryKey* key = geometry_key(p, row.value))
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", row.name, toml_value(as_value(key->value)));
    }
    return text;
  }
  if (!p.when_absent.empty()) return std::string(p.when_absent);
  Scene scene;
  for (const SettingsList& list : settings_lists()) list.append(scene.model);
  if (auto* const place = material_place(scene.model, p.section(), 0);
      place && p.belonging != Belonging::explicit_springs)
    place->emplace();
  if (p.belonging == Belonging::motion) scene.model.terrain[0].motion.emplace();
  if (p.belonging == Belonging::wave) scene.model.actuators[0].phase.along = BodyAxis::x;
  if (p.belonging == Belonging::signal_table) scene.model.actuators[0].signal = Signal::table;
  return toml_value(*p.get(scene, 0));
}

}  // namespace aspic
