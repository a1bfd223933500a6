#pragma once
// Terrain as the model holds it: settings completed by the shape's defaults.
#include "model/model.h"

namespace aspic {

/// Default geometry of each shape, spec §3: plane (0,−1,0) normal (0,1,0); tilted plane (0,0,0) normal
/// (1,1,0); sphere centre (0,−1,0) radius 3; bowl centre (2,7,1) radius 7.
TerrainSettings terrain_defaults(TerrainShape shape);

/// Completes a terrain: absent geometry from the shape's defaults, absent restitution and friction from
/// `contact`, absent mass infinite; the normal becomes a unit vector.
Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact);

/// Signed distance d(x) [m] of a point from the terrain, positive on the free side (spec §2.4), in double
/// precision: for reports and pictures. Solvers evaluate it in their own precision.
double signed_distance(const Terrain& terrain, const Vec3& x);

}  // namespace aspic
