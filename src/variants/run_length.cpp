#include "variants/run_length.h"

#include <cmath>

namespace aspic {

Result<std::uint64_t> steps_of(const RunLength& length, const SimulationSettings& simulation) {
  if (length.steps) return *length.steps;
  const double duration = length.duration.value_or(simulation.duration);
  const double steps = std::round(duration / simulation.timestep);
  if (!(steps <= static_cast<double>(most_steps))) {
    return fail(ErrorCode::usage, "{} s at a time step of {} s are too many steps.", duration,
                simulation.timestep);
  }
  return static_cast<std::uint64_t>(steps);
}

}  // namespace aspic
