#pragma once
// What lies between two scenes, for a run that goes from one to the other.
#include "aspic/scene.h"

namespace aspic {

/// What a change asks of the simulation.
enum class Effect {
  none,       ///< nothing changed
  view,       ///< the image alone
  constants,  ///< other constants; the state continues
  restart,    ///< another body or another start: the simulation restarts
  opening     ///< another source, or the same one again: as if it had been opened
};

/// What lies between two scenes, by the parameter table.
Effect effect_between(const Scene& before, const Scene& after);

}  // namespace aspic
