// What to say of stable steps.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "analysis/stability.h"

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
        "no step is {}stable for {}: undamped springs gain energy at any step. Add damping, or use "
        "symplectic-euler or runge-kutta-4",
        limit.exact ? "" : "certainly ", name_of(integrator));
  }
  if (std::isinf(*limit.step)) return fmt::format("nothing limits the step of {}", name_of(integrator));
  if (*limit.step == 0.0) {
    return fmt::format(
        "no step is certainly stable for {}: the springs are too stiff for their masses in double precision",
        name_of(integrator));
  }
  return fmt::format("the largest stable one for {} is {}{}", name_of(integrator),
                     limit.exact ? "estimated at " : "", stability_figure(limit));
}

std::string divergence_sentence(double timestep, Integrator integrator, const StabilityLimit& limit) {
  const std::string now = fmt::format("The time step is {:.4g} s", timestep);
  if (exceeds(timestep, limit)) return fmt::format("{}; {}.", now, stability_sentence(integrator, limit));
  const std::string known =
      std::isinf(*limit.step)
          ? fmt::format("small motions are stable under {} at any step", name_of(integrator))
          : fmt::format("small motions are stable under {} up to {}", name_of(integrator),
                        stability_figure(limit));
  return fmt::format("{}, and {}; a hit or a contact needed a smaller one. Try {:.4g} s.", now, known,
                     0.5 * timestep);
}

std::optional<double> step_to_try(double timestep, const StabilityLimit& limit) {
  if (!limit.step || !(*limit.step > 0.0)) return std::nullopt;
  if (!exceeds(timestep, limit)) return 0.5 * timestep;
  // Two digits below: an estimate is not trusted to its last one.
  const double most = 0.95 * *limit.step, unit = std::pow(10.0, std::floor(std::log10(most)) - 1.0);
  return std::floor(most / unit) * unit;
}

std::string unstable_sentence(double timestep, Integrator integrator, const StabilityLimit& limit) {
  return fmt::format("the time step {:.4g} s {} stable: {}.", timestep, limit.exact ? "is not" : "may not be",
                     stability_sentence(integrator, limit));
}

std::string unstable_step_warning(const Model& model, const StabilityWatch& watch) {
  const auto& [integrator, timestep] = std::pair(model.simulation.integrator, model.simulation.timestep);
  // The infinite lattice clears most cubes at once; a large one's own spectrum takes seconds.
  if (certainly_stable(model, integrator, timestep)) return "";
  const StabilityLimit limit = stability_limit(model, integrator, StabilityEffort::quick, watch);
  return exceeds(timestep, limit) ? unstable_sentence(timestep, integrator, limit) : "";
}

}  // namespace aspic
