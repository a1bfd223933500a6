#pragma once
// How far a run goes.
#include <cstdint>

#include "aspic/settings.h"
#include "aspic/sweep.h"
#include "base/result.h"

namespace aspic {

/// Largest number of steps: beyond 2⁵³ time, which is step·h in double precision, no longer tells steps
/// apart.
inline constexpr std::uint64_t most_steps = std::uint64_t{1} << 53;

/// Steps of a run of this length: as asked for, else the scene's duration, rounded to the nearest whole
/// step. Error (usage): more steps than can be counted.
Result<std::uint64_t> steps_of(const RunLength& length, const SimulationSettings& simulation);

}  // namespace aspic
