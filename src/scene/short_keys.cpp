#include "scene/short_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "scene/diagnostics.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

std::optional<double> number_at(const Scene& scene, const Parameter& parameter, std::size_t index) {
  const std::optional<Value> value = parameter.get(scene, index);
  if (!value) return std::nullopt;
  if (const auto* number = std::get_if<double>(&*value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&*value)) return static_cast<double>(*whole);
  return std::nullopt;
}

/// Every key with that ending that has a value above 0 in the scene, each in its ratio to the first.
std::vector<ShortKeyTarget> proportional(const Scene& scene, std::string_view ending) {
  std::vector<ShortKeyTarget> targets;
  double first = 0.0;
  for (const Parameter& p : parameters()) {
    if (!p.path.ends_with(ending) || p.belonging == Belonging::material) continue;
    for (std::size_t i = 0; i < index_count(p, scene); ++i) {
      const std::optional<double> value = number_at(scene, p, i);
      if (!value || !(*value > 0.0)) continue;
      if (targets.empty()) first = *value;
      targets.push_back({path_text(p.path, i), *value / first});
    }
  }
  return targets;
}

/// A key of all elements of its list, and one of the scene before them.
std::vector<ShortKeyTarget> everywhere(const Scene& scene, std::string_view scene_key,
                                       std::string_view list_key) {
  std::vector<ShortKeyTarget> targets;
  if (!scene_key.empty()) targets.push_back({std::string(scene_key)});
  if (list_key.empty()) return targets;
  const Parameter& p = *find_parameter(list_key);
  for (std::size_t i = 0; i < index_count(p, scene); ++i)
    if (applies(p, scene, i)) targets.push_back({path_text(p.path, i)});
  return targets;
}

constexpr ShortKey table[] = {
    {"integrator", "integrator", "", "simulation.integrator",
     [](const Scene& s) { return everywhere(s, "simulation.integrator", ""); }},
    {"h", "time step h", "s", "simulation.timestep",
     [](const Scene& s) { return everywhere(s, "simulation.timestep", ""); }},
    {"k", "stiffness k", "N/m",
     "stiffness of all springs: the first gets the value, the others keep their ratios to it",
     [](const Scene& s) { return proportional(s, ".stiffness"); }},
    {"c", "damping c", "N·s/m", "damping of all springs, likewise",
     [](const Scene& s) { return proportional(s, ".damping"); }},
    {"n", "particles per edge n", "", "particles-per-edge of all cubes, not of boxes",
     [](const Scene& s) { return everywhere(s, "", "cube[].particles-per-edge"); }},
    {"e", "restitution e", "", "contact.restitution, and that of every terrain",
     [](const Scene& s) { return everywhere(s, "contact.restitution", "terrain[].restitution"); }},
    {"mu", "friction μ", "", "contact.friction, and that of every terrain",
     [](const Scene& s) { return everywhere(s, "contact.friction", "terrain[].friction"); }},
};

}  // namespace

std::span<const ShortKey> short_keys() {
  return table;
}

const ShortKey* find_short_key(std::string_view name) {
  const auto* const found = std::ranges::find(table, name, &ShortKey::name);
  return found == std::end(table) ? nullptr : found;
}

Result<std::vector<std::string>> assignments(const Scene& scene, std::string_view key,
                                             const std::string& value) {
  const ShortKey* const row = find_short_key(key);
  if (!row) {
    // A word that is no key of a scene at all may be a short name mistyped.
    if (key.find_first_of(".[") == std::string_view::npos && !place_of(key)) {
      std::vector<std::string_view> names;
      for (const ShortKey& known : table) names.push_back(known.name);
      if (const std::string_view near = diagnostics::nearest(key, names); !near.empty())
        return fail(ErrorCode::usage, "unknown key '{}'{}", key, diagnostics::did_you_mean(near));
    }
    return std::vector<std::string>{fmt::format("{}={}", key, value)};
  }
  const std::vector<ShortKeyTarget> targets = row->targets(scene);
  if (targets.empty()) {
    return fail(ErrorCode::usage, "{} sets {}, but {} has none. List the scene's keys with aspic scene show.",
                key, row->meaning, scene.name);
  }
  std::vector<std::string> result;
  for (const ShortKeyTarget& target : targets) {
    if (target.factor == 1.0) {
      result.push_back(fmt::format("{}={}", target.path, value));
      continue;
    }
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc() || end != value.data() + value.size())
      return fail(ErrorCode::usage, "{} needs a number, not \"{}\".", key, value);
    result.push_back(fmt::format("{}={}", target.path, target.factor * number));
  }
  return result;
}

std::optional<KeyPlace> place_of(std::string_view path) {
  KeyPlace place;
  std::string row(path);
  const std::size_t open = row.find('['), close = row.find(']');
  if (open != std::string::npos && close != std::string::npos && close > open) {
    std::from_chars(row.data() + open + 1, row.data() + close, place.index);
    row.erase(open + 1, close - open - 1);
  }
  place.parameter = find_parameter(row);
  if (!place.parameter) return std::nullopt;
  const FormerKey* const former = find_former_key(row);
  place.path = former ? former->path : place.parameter->path;
  return place;
}

std::optional<KeyPlace> place_of(const Scene& scene, const ShortKey& key) {
  const std::vector<ShortKeyTarget> targets = key.targets(scene);
  return targets.empty() ? std::nullopt : place_of(targets.front().path);
}

std::optional<double> present_value(const Scene& scene, const ShortKey& key) {
  const auto place = place_of(scene, key);
  return place ? number_at(scene, *place->parameter, place->index) : std::nullopt;
}

bool takes_whole_numbers(const Scene& scene, std::string_view key) {
  const ShortKey* const short_key = find_short_key(key);
  const auto place = short_key ? place_of(scene, *short_key) : place_of(key);
  return place && place->parameter->type == ParameterType::integer;
}

}  // namespace aspic
