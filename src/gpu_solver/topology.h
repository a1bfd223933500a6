#pragma once
// The springs of a model as the kernels walk them: per particle, in ascending neighbour index, one word a
// spring.
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "gpu_solver/layout.h"
#include "model/model.h"

namespace aspic {

/// Compressed rows: particle i owns words[start[i]] … words[start[i + 1] − 1].
struct IncidentSprings {
  std::vector<std::uint32_t> start;  ///< particles + 1
  std::vector<std::uint32_t> words;  ///< 2 · springs
};

/// Words for the gather path: neighbour << class_bits | class.
/// Error (scene_rejected): more particles than the bits left by the class can name.
Result<IncidentSprings> neighbours_of(const Model& model);

/// Words for the per-spring path: spring << 1 | (1 if the particle is the spring's end b).
IncidentSprings springs_of(const Model& model);

/// The springs of the per-spring path: end a; end b << class_bits | class. Same limit as neighbours_of.
Result<std::vector<layout::uvec2>> packed_springs(const Model& model);

}  // namespace aspic
