#include "model/terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aspic {

std::string_view name_of(TerrainShape shape) {
  return terrain_row(shape).name;
}

const GeometryKey* geometry_key(TerrainShape shape, std::string_view name) {
  const auto keys = terrain_row(shape).keys;
  const auto found = std::ranges::find(keys, name, &GeometryKey::name);
  return found == keys.end() ? nullptr : &*found;
}

Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact) {
  Terrain t;
  t.shape = settings.shape;
  std::size_t vectors = 0, numbers = 0;
  for (const GeometryKey& key : terrain_row(settings.shape).keys) {
    const auto given = settings.geometry.find(key.name);
    const GeometryValue& value = given == settings.geometry.end() ? key.value : given->second;
    if (key.kind == GeometryKind::length) {
      t.geometry.numbers[numbers++] = std::get<double>(value);
    } else {
      const Vec3& v = std::get<Vec3>(value);
      t.geometry.vectors[vectors++] = key.kind == GeometryKind::direction ? v / length(v) : v;
    }
  }
  t.mass = settings.mass.value_or(std::numeric_limits<double>::infinity());
  t.restitution = settings.restitution.value_or(contact.restitution);
  t.friction = settings.friction.value_or(contact.friction);
  t.motion = settings.motion;
  if (t.motion) t.motion->direction = t.motion->direction / length(t.motion->direction);
  return t;
}

Pose pose_at(const TerrainMotion& motion, double timestep, std::uint64_t step) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double turns = motion.frequency * (timestep * static_cast<double>(step)) + motion.phase;
  const double angle = turn * (turns - std::floor(turns));
  return {(motion.amplitude * std::sin(angle)) * motion.direction,
          (motion.amplitude * (turn * motion.frequency) * std::cos(angle)) * motion.direction};
}

Terrain terrain_at(const Terrain& terrain, double timestep, std::uint64_t step) {
  if (!terrain.motion) return terrain;
  Terrain moved = terrain;
  const Vec3 offset = pose_at(*terrain.motion, timestep, step).offset;
  std::size_t vector = 0;
  for (const GeometryKey& key : terrain_row(terrain.shape).keys) {
    if (key.kind == GeometryKind::place)
      moved.geometry.vectors[vector] = moved.geometry.vectors[vector] + offset;
    if (key.kind != GeometryKind::length) ++vector;
  }
  return moved;
}

double signed_distance(const Terrain& terrain, const Vec3& x) {
  return terrain_row(terrain.shape).in_double.distance(terrain.geometry, x);
}

TerrainGap<double> terrain_gap(const Terrain& terrain, const Vec3& x) {
  return terrain_row(terrain.shape).in_double.gap(terrain.geometry, x);
}

double extent(const Terrain& terrain) {
  double size = 0.0;
  for (std::size_t k = 0; k < geometry_size; ++k) size = std::max(size, length(terrain.geometry.vectors[k]));
  for (const double number : terrain.geometry.numbers) size += number;
  return size;
}

double resting_speed(const Model& model) {
  return std::max(model.contact.resting_speed,
                  2.0 * length(model.simulation.gravity) * model.simulation.timestep);
}

double fall_speed(const Model& model) {
  return length(model.simulation.gravity) * model.simulation.timestep;
}

}  // namespace aspic
