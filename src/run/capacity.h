#pragma once
// What the device of --backend gpu takes at most.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "gpu_solver/capacity.h"

namespace aspic {

struct DeviceCapacity {
  std::string renderer;
  std::vector<CubeCapacity> cubes;  ///< by force path
};

/// Of the hardware GPU or, without one, of whatever device there is; nothing without any.
std::optional<DeviceCapacity> device_capacity(Integrator integrator);

/// Bytes that are free for buffers of this device: its own or, for a software rasterizer, the machine's.
/// Nothing where neither tells.
std::optional<std::uint64_t> free_bytes(gl::Context& context);

/// What ends it, as in "of 128 MiB in one block".
std::string limit_text(const CubeCapacity& capacity);

}  // namespace aspic
