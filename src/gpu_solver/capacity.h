#pragma once
// How large a cube a device takes, by force path.
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "gpu/context.h"
#include "gpu_solver/force_paths.h"
#include "model/integrator.h"

namespace aspic {

/// What ends the growth of a cube.
enum class CapacityLimit {
  block,   ///< the largest storage block
  buffer,  ///< the largest buffer
  memory,  ///< what the driver says is free
  words    ///< 32-bit words of springs
};

struct CubeCapacity {
  std::string_view force_path;
  std::uint32_t particles_per_edge = 0;        ///< of the largest cube alone in a scene
  CapacityLimit limit = CapacityLimit::block;  ///< of one particle more per edge
};

/// For each force path that the integrator takes. `free`: bytes of memory on the device; nothing: unknown.
std::vector<CubeCapacity> largest_cubes(const gl::DeviceLimits& limits, std::optional<std::uint64_t> free,
                                        Integrator integrator);

}  // namespace aspic
