#include "playback/effect.h"

#include <algorithm>

#include "model/bodies.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

Effect effect_of(const Parameter& p) {
  if (p.only_shown()) return Effect::view;
  return p.live ? Effect::constants : Effect::restart;
}

}  // namespace

Effect effect_between(const Scene& before, const Scene& after) {
  for (const BodyRow& row : body_rows()) {
    if (row.list.size(before.model) != row.list.size(after.model)) return Effect::restart;
  }
  Effect effect = Effect::none;
  for (const SettingsList& list : settings_lists())
    if (list.size(before.model) != list.size(after.model)) effect = Effect::constants;
  for (const Parameter& p : parameters()) {
    const std::size_t count = std::min(index_count(p, before), index_count(p, after));
    for (std::size_t i = 0; i < count; ++i) {
      if (p.get(before, i) != p.get(after, i)) effect = std::max(effect, effect_of(p));
    }
  }
  return effect;
}

}  // namespace aspic
