#include "page/terrain_shape.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "page/packing.h"

namespace aspic::page {
namespace {

constexpr int rings = 48, sectors = 96;
constexpr int side = 192;  // points along the square

struct Points {
  std::vector<Vec3> at;  // from the terrain's place [m]
  double extent = 0.0;   // of any component [m]
};

Points points_of(const Terrain& terrain) {
  Points points;
  const TerrainShapeRow& row = terrain_row(terrain.shape);
  for (int ring = 0; ring <= rings; ++ring) {
    for (int sector = 0; sector <= sectors; ++sector) {
      const Vec3 x = row.surface(terrain.geometry, static_cast<double>(sector) / sectors,
                                 static_cast<double>(ring) / rings) -
                     terrain.geometry.vectors[0];
      points.at.push_back(x);
      points.extent = std::max({points.extent, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    }
  }
  return points;
}

/// 1 if the turn from u to v is counterclockwise as seen from the side that is drawn as the outside, else −1.
int turn_of(const Terrain& terrain, const Points& points) {
  double sum = 0.0;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    for (std::size_t sector = 0; sector < sectors; ++sector) {
      const std::size_t i = ring * (sectors + 1) + sector;
      const Vec3& x = points.at[i];
      const Vec3 n = cross(points.at[i + 1] - x, points.at[i + sectors + 1] - x);
      sum += dot(n, terrain_gap(terrain, x + terrain.geometry.vectors[0]).n);
    }
  }
  return (sum < 0.0) == terrain_row(terrain.shape).glass ? 1 : -1;
}

constexpr double steps = 16384.0;  // of the surface's extent

}  // namespace

nlohmann::ordered_json surface_facts(const Terrain& terrain) {
  const Points points = points_of(terrain);
  nlohmann::ordered_json facts = {{"rings", rings},
                                  {"sectors", sectors},
                                  {"quantum", points.extent / steps},
                                  {"turn", turn_of(terrain, points)}};
  if (terrain_row(terrain.shape).flat) {
    const auto [u, v] = shapes::directions_across(terrain_row(terrain.shape).flat(terrain.geometry).normal);
    facts["side"] = side;
    facts["across"] = {u.x, u.y, u.z, v.x, v.y, v.z};
    facts["half"] = 1.1 * points.extent;
  }
  return facts;
}

void append_surface(const Terrain& terrain, std::string& bytes) {
  const Points points = points_of(terrain);
  std::vector<std::int32_t> numbers;
  const double quantum = points.extent / steps;
  for (double Vec3::*const component : {&Vec3::x, &Vec3::y, &Vec3::z})
    for (const Vec3& x : points.at)
      numbers.push_back(static_cast<std::int32_t>(std::lround(x.*component / quantum)));
  append_differences(numbers, bytes);
  const TerrainShapeRow& row = terrain_row(terrain.shape);
  if (!row.flat) return;
  const FlatPart flat = row.flat(terrain.geometry);
  const auto [u, v] = shapes::directions_across(flat.normal);
  const double half = 1.1 * points.extent, mesh = 2.0 * half / (side - 1);
  numbers.clear();
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const Vec3 x = flat.point + (i * mesh - half) * u + (j * mesh - half) * v;
      const double off = 64.0 * signed_distance(terrain, x) / mesh;
      numbers.push_back(static_cast<std::int32_t>(std::lround(std::clamp(off, -127.0, 127.0))));
    }
  }
  append_differences(numbers, bytes);
}

}  // namespace aspic::page
