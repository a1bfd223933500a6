#pragma once
// Vertices that are equal become one.
#include <cstdint>
#include <span>
#include <vector>

#include "aspic/vec.h"

namespace aspic {

/// For each point the index of the first one that is equal to it, or nearer than `tolerance` to it and to no
/// earlier such one; itself where there is none. In time proportional to the number of points, wherever they
/// are. Points are finite; `tolerance` is at least 2⁻²⁰ of their largest extent.
std::vector<std::uint32_t> weld_points(std::span<const Vec3> points, double tolerance);

}  // namespace aspic
