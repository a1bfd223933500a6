#pragma once
// Terrain contact of a piece of the particles. Most pieces are far from all terrain: a box around them says
// so, and then nothing else is looked at. Near it every particle is treated by the reference's own formulas.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cpu_parallel/kernels.h"
#include "cpu_reference/dynamics.h"
#include "model/terrain.h"

namespace aspic::parallel {

using Vector = physics::Vector<float>;

inline Vector vector_of(const VectorArray& a, std::size_t i) {
  return {a[0][i], a[1][i], a[2][i]};
}
inline void set(VectorArray& a, std::size_t i, const Vector& v) {
  for (std::size_t c = 0; c < 3; ++c) a[c][i] = v[static_cast<Eigen::Index>(c)];
}

/// How far the vectors of a terrain's geometry reach from the origin [m]: what rounding of its distance
/// scales with.
inline double reach_of(const Terrain& terrain) {
  double reach = 0.0;
  for (const Vec3& v : terrain.geometry.vectors) reach += length(v);
  return reach;
}

/// How far a terrain may be from where it is at rest [m], at any time.
inline double sway_of(const Terrain& terrain) {
  return terrain.motion ? terrain.motion->amplitude : 0.0;
}

/// How near a terrain at rest a point may be that counts as near it: ε, the way of one that moves, and a
/// margin. Distances in single precision differ from true ones by a few rounding errors of the coordinates,
/// here of points within `radius` of `center`: 1e-5 of them is beyond all.
inline double nearness(const Model& model, const Terrain& terrain, const Vec3& center, double radius) {
  const double sway = sway_of(terrain);
  return model.contact.distance + sway + 1e-5 * (length(center) + radius + reach_of(terrain) + sway);
}

/// Whether a point of the box may be nearer than ε to any terrain, wherever a moving one is.
inline bool near_terrain(const Model& model, const Box& box) {
  const Vec3 min = {box.min[0], box.min[1], box.min[2]}, max = {box.max[0], box.max[1], box.max[2]};
  const Vec3 center = 0.5 * (min + max), half = 0.5 * (max - min);
  const double radius = length(half);
  return std::ranges::any_of(model.terrain, [&](const Terrain& terrain) {
    const double near = nearness(model, terrain, center, radius);
    // All of a terrain with a flat part lies behind it; a box in front, however large, is told by its corner.
    if (const auto flat = terrain_row(terrain.shape).flat) {
      const auto [point, n] = flat(terrain.geometry);
      const double corner = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
      if (dot(center - point, n) > corner + near) return false;
    }
    return !(signed_distance(terrain, center) > radius + near);
  });
}

/// Places x with normal·x > limit are farther than ε from a terrain, wherever a moving one is: for points of
/// a box that may be near.
struct FarSide {
  Vec3 normal;
  double limit;
};
/// Nowhere, unless all of the terrain lies behind a flat part.
inline FarSide far_side(const Model& model, const Terrain& terrain, const Box& box) {
  const auto flat = terrain_row(terrain.shape).flat;
  if (!flat) return {{}, std::numeric_limits<double>::infinity()};
  const Vec3 min = {box.min[0], box.min[1], box.min[2]}, max = {box.max[0], box.max[1], box.max[2]};
  const auto [point, n] = flat(terrain.geometry);
  return {n, dot(point, n) + nearness(model, terrain, 0.5 * (min + max), length(0.5 * (max - min)))};
}

}  // namespace aspic::parallel
