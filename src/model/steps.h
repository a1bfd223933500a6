#pragma once
// Times as numbers of steps.
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aspic {

/// The step whose time is nearest to `time` [s], at least 0; at most 2⁶², which no run reaches.
inline std::uint64_t nearest_step(double time, double timestep) {
  return static_cast<std::uint64_t>(std::llround(std::clamp(time / timestep, 0.0, 0x1p62)));
}

}  // namespace aspic
