#pragma once
// What the device of --backend gpu takes at most.
#include <optional>
#include <string>
#include <vector>

#include "gpu_solver/reach.h"

namespace aspic {

struct DeviceReach {
  std::string renderer;
  std::vector<CubeReach> cubes;  ///< by force path
};

/// Of the hardware GPU or, without one, of whatever device there is; nothing without any.
std::optional<DeviceReach> device_reach(Integrator integrator);

/// What ends it, as in "of 128 MiB in one block".
std::string limit_text(const CubeReach& reach);

}  // namespace aspic
