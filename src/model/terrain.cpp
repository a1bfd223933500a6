#include "model/terrain.h"

namespace aspic {

TerrainSettings terrain_defaults(TerrainShape shape) {
  TerrainSettings d;
  d.shape = shape;
  switch (shape) {
    case TerrainShape::plane:
      d.point = Vec3{0.0, -1.0, 0.0};
      d.normal = Vec3{0.0, 1.0, 0.0};
      break;
    case TerrainShape::tilted_plane:
      d.point = Vec3{0.0, 0.0, 0.0};
      d.normal = Vec3{1.0, 1.0, 0.0};
      break;
    case TerrainShape::sphere:
      d.centre = Vec3{0.0, -1.0, 0.0};
      d.radius = 3.0;
      break;
    case TerrainShape::bowl:
      d.centre = Vec3{2.0, 7.0, 1.0};
      d.radius = 7.0;
      break;
  }
  return d;
}

Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact) {
  const TerrainSettings defaults = terrain_defaults(settings.shape);
  Terrain t;
  t.shape = settings.shape;
  if (settings.shape == TerrainShape::plane || settings.shape == TerrainShape::tilted_plane) {
    t.point = settings.point.value_or(*defaults.point);
    const Vec3 normal = settings.normal.value_or(*defaults.normal);
    t.normal = normal / length(normal);
  } else {
    t.point = settings.centre.value_or(*defaults.centre);
    t.radius = settings.radius.value_or(*defaults.radius);
  }
  t.mass = settings.mass.value_or(std::numeric_limits<double>::infinity());
  t.restitution = settings.restitution.value_or(contact.restitution);
  t.friction = settings.friction.value_or(contact.friction);
  return t;
}

double signed_distance(const Terrain& terrain, const Vec3& x) {
  switch (terrain.shape) {
    case TerrainShape::plane:
    case TerrainShape::tilted_plane:
      return dot(terrain.normal, x - terrain.point);
    case TerrainShape::sphere:
      return length(x - terrain.point) - terrain.radius;
    case TerrainShape::bowl:
      return terrain.radius - length(x - terrain.point);
  }
  return 0.0;
}

}  // namespace aspic
