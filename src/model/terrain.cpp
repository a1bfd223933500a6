#include "model/terrain.h"

#include <algorithm>

namespace aspic {

const TerrainShapeRow& terrain_row(TerrainShape shape) {
  return *std::ranges::find(terrain_shapes, shape, &TerrainShapeRow::value);
}

std::string_view name_of(TerrainShape shape) {
  return terrain_row(shape).name;
}

Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact) {
  const TerrainSettings& defaults = terrain_row(settings.shape).defaults;
  Terrain t;
  t.shape = settings.shape;
  if (defaults.point) t.point = settings.point.value_or(*defaults.point);
  if (defaults.centre) t.point = settings.centre.value_or(*defaults.centre);
  if (defaults.normal) {
    const Vec3 normal = settings.normal.value_or(*defaults.normal);
    t.normal = normal / length(normal);
  }
  if (defaults.radius) t.radius = settings.radius.value_or(*defaults.radius);
  t.mass = settings.mass.value_or(std::numeric_limits<double>::infinity());
  t.restitution = settings.restitution.value_or(contact.restitution);
  t.friction = settings.friction.value_or(contact.friction);
  return t;
}

double signed_distance(const Terrain& terrain, const Vec3& x) {
  return terrain_row(terrain.shape).signed_distance(terrain, x);
}

}  // namespace aspic
