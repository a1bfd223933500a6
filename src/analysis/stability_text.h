#pragma once
#include <string>

#include "analysis/stability.h"

namespace aspic {

/// Whether a time step [s] is above the limit. A bound that is not exact counts: the warning is then a
/// caution.
bool exceeds(double timestep, const StabilityLimit& limit);

/// "0.002048 s", "at least 0.0013 s", "none", "any".
std::string stability_figure(const StabilityLimit& limit);

/// "the largest stable one for explicit-euler is 0.002048 s": part of a sentence.
std::string stability_sentence(Integrator integrator, const StabilityLimit& limit);

}  // namespace aspic
