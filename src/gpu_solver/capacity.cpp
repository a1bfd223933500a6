#include "gpu_solver/capacity.h"

#include <algorithm>

#include "gpu_solver/device_solver.h"
#include "gpu_solver/layout.h"
#include "model/cube.h"

namespace aspic {
namespace {

/// What keeps a cube from this path, if anything does.
std::optional<CapacityLimit> obstacle(const ForcePathRow& path, Integrator integrator, std::uint64_t n,
                                      const gl::DeviceLimits& limits, std::optional<std::uint64_t> free) {
  const auto edge = static_cast<int>(n);
  const std::uint64_t particles = n * n * n, springs = box_counts({edge, edge, edge}).springs();
  const bool lattice = !path.lattice_kernel.empty();
  const DeviceMethod& method = device_method(integrator, particles);
  // Slices are as long as their longest list: nearly everywhere a particle has all directions.
  const std::uint64_t slots = (particles + SPRING_SLICE - 1) / SPRING_SLICE * SPRING_SLICE,
                      words = lattice ? 0 : slots * LATTICE_DIRECTIONS;
  const std::uint64_t listed = path.words == IncidentWords::springs ? springs : 0;
  const std::uint64_t largest = std::max({particles * method.particle_bytes, words * sizeof(std::uint32_t),
                                          listed * sizeof(layout::uvec2), springs * path.spring_bytes});
  if (largest > limits.buffer_bytes) return CapacityLimit::buffer;
  if (largest > limits.storage_block_bytes) return CapacityLimit::block;
  // A word holds a particle and two bits of class, or a spring and its side.
  if (words > 0xffffffffu || (!lattice && particles >= 1u << 30) || 2 * listed > 0xffffffffu)
    return CapacityLimit::words;
  ModelCounts counts;
  counts.particles = particles;
  const std::uint64_t all = method.bytes(counts, integrator) + words * sizeof(std::uint32_t) +
                            listed * sizeof(layout::uvec2) + springs * path.spring_bytes;
  if (free && all > *free) return CapacityLimit::memory;
  return std::nullopt;
}

}  // namespace

std::vector<CubeCapacity> largest_cubes(const gl::DeviceLimits& limits, std::optional<std::uint64_t> free,
                                        Integrator integrator) {
  std::vector<CubeCapacity> result;
  for (const ForcePathRow& path : force_paths()) {
    if (!works_with(path.path, integrator)) continue;
    CubeCapacity capacity = {path.name, 2, CapacityLimit::block};
    constexpr std::uint32_t most = 2000;  // whose particles no 32-bit index counts
    while (capacity.particles_per_edge < most) {
      const auto ends = obstacle(path, integrator, capacity.particles_per_edge + 1, limits, free);
      if (ends) {
        capacity.limit = *ends;
        break;
      }
      ++capacity.particles_per_edge;
    }
    result.push_back(capacity);
  }
  return result;
}

}  // namespace aspic
