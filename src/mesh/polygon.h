#pragma once
// Polygons as triangles.
#include <span>

#include "model/triangle_mesh.h"

namespace aspic {

/// Corners up to which a concave polygon is cut by its ears, whose time grows with their square.
inline constexpr std::size_t most_cut_corners = 2000;

/// Cuts a polygon of n corners, given as the fan of its n − 2 triangles over the first corner, in place. A
/// fan without a triangle outside of the polygon stays, as that of a convex polygon does; one of more than 64
/// corners is halved again and again where that has none outside. Otherwise ears are cut off in the polygon's
/// plane (Meisters, 1975). Corners are below the number of vertices. False: the polygon has too many corners,
/// and stays a fan.
[[nodiscard]] bool cut_polygon(std::span<const Vec3> vertices, std::span<Triangle> fan);

}  // namespace aspic
