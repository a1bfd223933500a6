#include <fmt/format.h>

#include <array>

#include "aspic/parameters.h"
#include "scene/follow.h"
#include "scene/parameters.h"
#include "scene/short_keys.h"

namespace aspic {

std::vector<ParameterInfo> list_parameters() {
  std::vector<ParameterInfo> list;
  for (const Parameter& p : parameters()) {
    list.push_back({std::string(p.path), std::string(p.meaning), std::string(p.unit), allowed_text(p),
                    default_text(p), p.live});
  }
  return list;
}

std::vector<std::string> list_keys(const Scene& scene) {
  std::vector<std::string> keys;
  for (const Parameter& p : parameters()) {
    for (std::size_t i = 0; i < index_count(p, scene); ++i)
      if (applies(p, scene, i)) keys.push_back(path_text(p.path, i));
  }
  return keys;
}

namespace {

/// The key with the index of an element in the place of its name: `material[0].density` of
/// `material[fat].density`.
std::string with_index(const Scene& scene, const std::string& key) {
  const std::size_t open = key.find('['), close = key.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return key;
  const auto index = element_named(scene, key.substr(0, open), key.substr(open + 1, close - open - 1));
  return index ? fmt::format("{}[{}]{}", key.substr(0, open), *index, key.substr(close + 1)) : key;
}

}  // namespace

Result<std::optional<ParameterValue>> value_of(const Scene& scene, const std::string& given) {
  const std::string key = with_index(scene, given);
  const auto place = place_of(key);
  // place_of() is lenient about what is in the brackets.
  if (place && place->index < index_count(*place->parameter, scene) &&
      path_text(place->path, place->index) == key)
    return place->parameter->get(scene, place->index);
  // What is wrong with it, --set says best: it takes no such key, whatever the value.
  const std::array assignment = {key + "=0"};
  auto refused = with_overrides(scene, assignment);
  if (!refused) return refused.error();
  return fail(ErrorCode::scene_rejected, "unknown key {}. Name a key that has a value.", key);
}

std::vector<std::string> body_names(const ModelSettings& settings) {
  return followable(settings, 0);
}

}  // namespace aspic
