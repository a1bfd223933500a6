// Frequencies that change while a run goes on.
#include <algorithm>
#include <cmath>

#include "aspic/model.h"

namespace aspic {
namespace {

/// φ' with which f'·t + φ' = f·t + φ, up to whole turns.
double continued(double phase, double before, double after, double time) {
  const double turns = phase + (before - after) * time;
  return turns - std::floor(turns);
}

}  // namespace

ModelSettings with_continuous_phases(ModelSettings settings, const ModelSettings& before, double time) {
  for (std::size_t t = 0; t < std::min(settings.terrain.size(), before.terrain.size()); ++t) {
    auto& now = settings.terrain[t].motion;
    const auto& old = before.terrain[t].motion;
    if (now && old && now->frequency != old->frequency && now->phase == old->phase)
      now->phase = continued(now->phase, old->frequency, now->frequency, time);
  }
  for (std::size_t a = 0; a < std::min(settings.actuators.size(), before.actuators.size()); ++a) {
    ActuatorSettings& now = settings.actuators[a];
    const ActuatorSettings& old = before.actuators[a];
    const double since = std::max(time - now.start, 0.0);
    if (now.frequency != old.frequency && now.phase.offset == old.phase.offset)
      now.phase.offset = continued(now.phase.offset, old.frequency, now.frequency, since);
  }
  return settings;
}

}  // namespace aspic
