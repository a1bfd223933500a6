#include "variants/variant.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "model/integrator.h"
#include "render/overlay_text.h"
#include "scene/parameters.h"
#include "scene/short_keys.h"
#include "scene/write.h"

namespace aspic {

Result<Variant> varied(const Scene& scene, const BackendChoice& backend,
                       std::span<const Difference> differences) {
  Variant run = {scene, backend};
  std::vector<std::string> overrides;
  for (const Difference& difference : differences) {
    if (difference.key == backend_key) {
      ASPIC_TRY(run.backend, parse_backend(difference.value, backend));
      ASPIC_CHECK(check_choice(run.backend));
      continue;
    }
    ASPIC_TRY(auto more, assignments(scene, difference.key, difference.value));
    overrides.insert(overrides.end(), std::make_move_iterator(more.begin()),
                     std::make_move_iterator(more.end()));
  }
  ASPIC_TRY(run.scene, with_overrides(std::move(run.scene), overrides));
  return run;
}

std::string title_of(std::string_view key) {
  const ShortKey* const row = find_short_key(key);
  return std::string(row ? row->title : key);
}

std::string value_of(std::string_view key, const Scene& scene, std::string_view backend) {
  if (key == backend_key) return std::string(backend);
  const ShortKey* const row = find_short_key(key);
  const std::optional<KeyPlace> place = row ? place_of(scene, *row) : place_of(key);
  const auto value = place && place->index < index_count(*place->parameter, scene)
                         ? place->parameter->get(scene, place->index)
                         : std::nullopt;
  if (!value) return "-";
  const Parameter& parameter = *place->parameter;
  if (parameter.path == "simulation.integrator")
    return std::string(row_of(scene.model.simulation.integrator).title);
  std::string text;
  if (const auto* number = std::get_if<double>(&*value))
    text = short_number(*number);
  else if (const auto* words = std::get_if<std::string>(&*value))
    text = *words;
  else
    text = toml_value(*value);
  if (!parameter.unit.empty()) text += fmt::format(" {}", parameter.unit);
  return text;
}

}  // namespace aspic
