#pragma once
#include <string>

#include "analysis/stability.h"

namespace aspic {

/// Whether a time step [s] is above the limit. A bound that is not exact counts: the warning is then a
/// caution.
bool exceeds(double timestep, const StabilityLimit& limit);

/// "0.002048 s", "at least 0.0013 s", "none", "any".
std::string stability_figure(const StabilityLimit& limit);

/// "the largest stable one for explicit-euler is estimated at 0.002048 s", or "is at least …" where that is
/// all that is known: part of a sentence.
std::string stability_sentence(Integrator integrator, const StabilityLimit& limit);

/// "the time step 0.01 s is not stable: …." or "may not be stable", for a step that exceeds the limit.
std::string unstable_sentence(double timestep, Integrator integrator, const StabilityLimit& limit);

}  // namespace aspic
