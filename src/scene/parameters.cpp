#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/cube.h"
#include "model/terrain.h"
#include "scene/diagnostics.h"
#include "scene/write.h"

namespace aspic {
namespace {

/// Shorter directions lose their digits when their length is squared.
constexpr double shortest_direction = 1e-100;

bool is_round(TerrainShape shape) {
  return shape == TerrainShape::sphere || shape == TerrainShape::bowl;
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
    const char* hint = p.when_absent == "infinite" ? "; leave the key out for an infinite one" : "";
    return fmt::format("'{}' must be finite, not {}{}; allowed: {}", key_text(p), value, hint,
                       allowed_text(p));
  }
  const Range& r = p.range;
  if (value < r.min || value > r.max || (r.min_excluded && value == r.min)) {
    if (p.path == "schema") {
      return fmt::format("unknown schema version {}; this version of the program reads schema = {}", value,
                         scene_schema);
    }
    return fmt::format("'{}' is out of range: {}; allowed: {}", key_text(p), value, allowed_text(p));
  }
  // The default precision is single: what is positive here must be so there.
  if (r.min_excluded && static_cast<float>(value) <= static_cast<float>(r.min)) {
    return fmt::format("'{}' is out of range: {} is zero in single precision; allowed: {}", key_text(p),
                       value, allowed_text(p));
  }
  return std::nullopt;
}

std::optional<std::string> complaint_about_word(const Parameter& p, const std::string& word) {
  if (std::find(p.words.begin(), p.words.end(), word) != p.words.end()) return std::nullopt;
  return fmt::format("'{}' does not know \"{}\"; allowed: {}{}", key_text(p), word, allowed_text(p),
                     diagnostics::did_you_mean(diagnostics::nearest(word, p.words)));
}

constexpr std::string_view faces[] = {"top", "bottom", "left", "right", "front", "back"};

std::optional<std::string> complaint_about_pinned_name(const Parameter& p, const std::string& name) {
  // The model alone knows the names: the smallest cube is asked.
  CubeSettings smallest;
  smallest.particles_per_edge = 2;
  smallest.pinned.names = {name};
  Model scratch;
  if (add_cube(scratch, smallest)) return std::nullopt;
  return fmt::format("'{}' does not know \"{}\"; allowed: {}{}", key_text(p), name, allowed_text(p),
                     diagnostics::did_you_mean(diagnostics::nearest(name, faces)));
}

}  // namespace

std::optional<Value> Parameter::get(const Scene& scene, std::size_t index) const {
  if (!applies(*this, scene, index)) return std::nullopt;
  std::optional<Value> value = read(*this, scene, index);
  if (!value && (belonging == Belonging::plane || belonging == Belonging::round)) {
    Scene defaults;
    defaults.model.terrain.push_back(terrain_defaults(scene.model.terrain[index].shape));
    return read(*this, defaults, 0);
  }
  return value;
}

const Parameter* find_parameter(std::string_view path) {
  const auto all = parameters();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& p) { return p.path == path; });
  return found == all.end() ? nullptr : &*found;
}

std::string key_text(const Parameter& parameter) {
  std::string text(parameter.path);
  if (const std::size_t brackets = text.find("[]"); brackets != std::string::npos) text.erase(brackets, 2);
  return text;
}

PathKind path_kind(std::string_view path) {
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
    case Belonging::plane:
      return !is_round(scene.model.terrain[index].shape);
    case Belonging::round:
      return is_round(scene.model.terrain[index].shape);
    case Belonging::explicit_springs:
      return !scene.model.cubes[index].material.has_value();
    case Belonging::material:
      return scene.model.cubes[index].material.has_value();
  }
  return false;
}

bool belongs_to_shape(const Parameter& parameter, TerrainShape shape) {
  if (parameter.belonging == Belonging::plane) return !is_round(shape);
  return parameter.belonging != Belonging::round || is_round(shape);
}

std::size_t index_count(const Parameter& parameter, const Scene& scene) {
  if (parameter.path.starts_with("terrain[]")) return scene.model.terrain.size();
  if (parameter.path.starts_with("cube[]")) return scene.model.cubes.size();
  if (parameter.path.starts_with("goal-net[]")) return scene.model.goal_nets.size();
  if (parameter.path.starts_with("ball[]")) return scene.model.balls.size();
  if (parameter.path.starts_with("launcher[]")) return scene.model.launchers.size();
  return 1;
}

void append_element(Scene& scene, std::string_view list) {
  if (list == "terrain") scene.model.terrain.emplace_back();
  if (list == "cube") scene.model.cubes.emplace_back();
  if (list == "goal-net") scene.model.goal_nets.emplace_back();
  if (list == "ball") scene.model.balls.emplace_back();
  if (list == "launcher") scene.model.launchers.emplace_back();
}

std::optional<Complaint> check_value(const Parameter& p, const Value& value) {
  const auto complaint = [](std::optional<std::string> message) -> std::optional<Complaint> {
    return message ? std::optional<Complaint>({std::nullopt, *message}) : std::nullopt;
  };
  switch (p.type) {
    case ParameterType::boolean:
    case ParameterType::text:
      return std::nullopt;
    case ParameterType::integer:
      return complaint(complaint_about(p, static_cast<double>(std::get<std::int64_t>(value))));
    case ParameterType::number:
      return complaint(complaint_about(p, std::get<double>(value)));
    case ParameterType::word:
      return complaint(complaint_about_word(p, std::get<std::string>(value)));
    case ParameterType::words: {
      const auto& words = std::get<std::vector<std::string>>(value);
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (auto message = complaint_about_word(p, words[i])) return Complaint{i, *message};
        if (std::find(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(i), words[i]) !=
            words.begin() + static_cast<std::ptrdiff_t>(i)) {
          return Complaint{i, fmt::format("'{}' names \"{}\" twice", key_text(p), words[i])};
        }
      }
      return std::nullopt;
    }
    case ParameterType::vector: {
      const Vec3& v = std::get<Vec3>(value);
      for (int axis = 0; axis < 3; ++axis) {
        if (auto message = complaint_about(p, v[axis]))
          return Complaint{static_cast<std::size_t>(axis), *message};
      }
      if (p.direction && length(v) < shortest_direction) {
        return Complaint{std::nullopt, fmt::format("'{}' has no direction: its length is zero; allowed: {}",
                                                   key_text(p), allowed_text(p))};
      }
      return std::nullopt;
    }
    case ParameterType::counts: {
      const auto& counts = std::get<std::array<int, 3>>(value);
      for (std::size_t i = 0; i < counts.size(); ++i) {
        if (auto message = complaint_about(p, counts[i])) return Complaint{i, *message};
      }
      return std::nullopt;
    }
    case ParameterType::pinned: {
      const auto& names = std::get<PinnedSettings>(value).names;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (auto message = complaint_about_pinned_name(p, names[i])) return Complaint{i, *message};
      }
      return std::nullopt;
    }
  }
  return std::nullopt;
}

std::string allowed_text(const Parameter& p) {
  switch (p.type) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return fmt::format("a whole number, {}", range_text(p));
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
      return fmt::format("three whole numbers [along x, y, z], each {}", range_text(p));
    case ParameterType::pinned:
      return fmt::format(
          "an array of faces ({}), corners (three faces joined by hyphens, such as left-top-front) and local "
          "indices 0 … n³ − 1",
          diagnostics::list_text(faces, false));
  }
  return "";
}

std::string default_text(const Parameter& p) {
  if (p.belonging == Belonging::plane || p.belonging == Belonging::round) {
    std::string text;
    for (const std::string_view word : find_parameter("terrain[].shape")->words) {
      Scene scene;
      scene.model.terrain.emplace_back();
      find_parameter("terrain[].shape")->set(scene, 0, Value(std::string(word)));
      const auto value = p.get(scene, 0);
      if (value) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", word, toml_value(*value));
    }
    return text;
  }
  if (!p.when_absent.empty()) return std::string(p.when_absent);
  Scene scene;
  for (const std::string_view list : {"terrain", "cube", "goal-net", "ball", "launcher"})
    append_element(scene, list);
  if (p.belonging == Belonging::material) scene.model.cubes[0].material.emplace();
  return toml_value(*p.get(scene, 0));
}

}  // namespace aspic
