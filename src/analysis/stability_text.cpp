#include "analysis/stability_text.h"

#include <fmt/format.h>

#include <cmath>

namespace aspic {

bool exceeds(double timestep, const StabilityLimit& limit) {
  return !limit.step || timestep > *limit.step;
}

std::string stability_figure(const StabilityLimit& limit) {
  if (!limit.step) return limit.exact ? "none" : "none is certain";
  if (*limit.step == 0.0) return "none is certain";
  if (std::isinf(*limit.step)) return "any";
  return fmt::format("{}{:.4g} s", limit.exact ? "" : "at least ", *limit.step);
}

std::string stability_sentence(Integrator integrator, const StabilityLimit& limit) {
  if (!limit.step) {
    return fmt::format(
        "no step is {}stable for {}, under which undamped springs gain energy at any step; add damping, or "
        "use symplectic-euler or runge-kutta-4",
        limit.exact ? "" : "certainly ", name_of(integrator));
  }
  if (std::isinf(*limit.step)) return fmt::format("nothing limits the step of {}", name_of(integrator));
  if (*limit.step == 0.0) {
    return fmt::format(
        "no step is certainly stable for {}: the springs are stiffer for their masses than double precision "
        "can express",
        name_of(integrator));
  }
  return fmt::format("the largest stable one for {} is {}{}", name_of(integrator),
                     limit.exact ? "estimated at " : "", stability_figure(limit));
}

std::string unstable_sentence(double timestep, Integrator integrator, const StabilityLimit& limit) {
  return fmt::format("the time step {} s {} stable: {}.", timestep, limit.exact ? "is not" : "may not be",
                     stability_sentence(integrator, limit));
}

}  // namespace aspic
