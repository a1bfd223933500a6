#pragma once
// The goal net: back, top and two sides of a box of lattice points, joined along the faces.
#include <array>
#include <cstdint>
#include <optional>

#include "model/counts.h"
#include "model/model.h"

namespace aspic {

/// Particles, pinned particles and springs of a net by closed form. 10 × 20 × 35 has 1,357 particles, 211 of
/// them pinned, and 2,650 structural springs.
ModelCounts goal_net_counts(const GoalNetSettings& net);

/// Local index of the particle at lattice point (i, j, k), each 0 … its count − 1: the particles that exist
/// count in the order of the cuboid index (i·nh + j)·nl + k. Nothing where the net has no particle: a point
/// exists in the back i = 0, the top j = nh − 1 and the sides k = 0 and k = nl − 1.
std::optional<std::uint32_t> net_index(const std::array<int, 3>& lattice, int i, int j, int k);

}  // namespace aspic
