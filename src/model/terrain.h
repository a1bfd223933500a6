#pragma once
// Terrain: the table of shapes, and terrain as the model holds it.
#include <string_view>

#include "model/model.h"

namespace aspic {

/// One shape. Parser, --set, defaults, checks, documentation and the window's buttons iterate the table.
struct TerrainShapeRow {
  TerrainShape value;
  std::string_view name;     ///< in scene files
  std::string_view title;    ///< for people
  TerrainSettings defaults;  ///< the geometry keys the shape has, and no others, hold their default values
  /// Signed distance [m] of a point, positive on the free side, in double precision.
  double (*signed_distance)(const Terrain&, const Vec3&);
};

/// Every shape, in the order in which they are listed for users.
inline constexpr TerrainShapeRow terrain_shapes[] = {
    {TerrainShape::plane,
     "plane",
     "plane",
     {.shape = TerrainShape::plane, .point = Vec3{0.0, -1.0, 0.0}, .normal = Vec3{0.0, 1.0, 0.0}},
     [](const Terrain& t, const Vec3& x) { return dot(t.normal, x - t.point); }},
    {TerrainShape::tilted_plane,
     "tilted-plane",
     "tilted plane",
     {.shape = TerrainShape::tilted_plane, .point = Vec3{0.0, 0.0, 0.0}, .normal = Vec3{1.0, 1.0, 0.0}},
     [](const Terrain& t, const Vec3& x) { return dot(t.normal, x - t.point); }},
    {TerrainShape::sphere,
     "sphere",
     "sphere",
     {.shape = TerrainShape::sphere, .centre = Vec3{0.0, -1.0, 0.0}, .radius = 3.0},
     [](const Terrain& t, const Vec3& x) { return length(x - t.point) - t.radius; }},
    {TerrainShape::bowl,
     "bowl",
     "bowl",
     {.shape = TerrainShape::bowl, .centre = Vec3{2.0, 7.0, 1.0}, .radius = 7.0},
     [](const Terrain& t, const Vec3& x) { return t.radius - length(x - t.point); }},
};

/// The row of a shape.
const TerrainShapeRow& terrain_row(TerrainShape shape);

/// Completes a terrain: absent geometry from the shape's defaults, absent restitution and friction from
/// `contact`, absent mass infinite; the normal becomes a unit vector.
Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact);

/// Signed distance d(x) [m] of a point from the terrain, positive on the free side, in double precision: for
/// reports and pictures. Solvers evaluate it in their own precision.
double signed_distance(const Terrain& terrain, const Vec3& x);

}  // namespace aspic
