#include "render/terrain_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/terrain.h"
#include "render/color_map.h"

namespace aspic {
namespace {

constexpr int tiles = 4;

/// A number 0…1 for a lattice point, by integer mixing (finaliser of MurmurHash3, Appleby 2011).
double hashed(std::uint32_t x, std::uint32_t y, std::uint32_t salt) {
  std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ salt * 0xc2b2ae3du;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return static_cast<double>(h ^ (h >> 16)) / 4294967295.0;
}

/// Value noise of `period` cells across the texture, repeating, −1…1. u, v in 0…1.
double noise(double u, double v, std::uint32_t period, std::uint32_t salt) {
  const double x = u * period, y = v * period;
  const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
  const auto ease = [](double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); };
  const double s = ease(x - i), t = ease(y - j);
  const auto at = [&](std::uint32_t di, std::uint32_t dj) {
    return hashed((i + di) % period, (j + dj) % period, salt);
  };
  const double low = at(0, 0) + s * (at(1, 0) - at(0, 0));
  const double high = at(0, 1) + s * (at(1, 1) - at(0, 1));
  return 2.0 * (low + t * (high - low)) - 1.0;
}

}  // namespace

Mesh square_mesh() {
  return {{{-1, -1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}, {-1, 1, 0, 1}}, {}, {0, 1, 2, 0, 2, 3}};
}

Mesh sphere_mesh(int rings, int sectors) {
  Terrain unit_sphere;
  unit_sphere.shape = TerrainShape::sphere;
  unit_sphere.geometry.numbers[0] = 1.0;
  return terrain_mesh(unit_sphere, rings, sectors);
}

Mesh terrain_mesh(const Terrain& terrain, int rings, int sectors) {
  const TerrainShapeRow& row = terrain_row(terrain.shape);
  std::vector<Vec3> points, normals;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int sector = 0; sector <= sectors; ++sector) {
      points.push_back(row.surface(terrain.geometry, static_cast<double>(sector) / sectors,
                                   static_cast<double>(ring) / rings));
      const Vec3 n = terrain_gap(terrain, points.back()).n;
      normals.push_back(row.glass ? -n : n);
    }
  }
  Mesh mesh;
  for (std::size_t i = 0; i < points.size(); ++i) {
    mesh.vertices.push_back(four(points[i], 1.0));
    mesh.normals.push_back(four(normals[i], 0.0));
  }
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Vec3 area = cross(points[b] - points[a], points[c] - points[a]);
    const double size = length(points[b] - points[a]) + length(points[c] - points[a]);
    if (length(area) < 1e-9 * size * size) return;  // at a pole
    if (dot(area, normals[a] + normals[b] + normals[c]) < 0.0) std::swap(b, c);
    for (const std::size_t i : {a, b, c}) mesh.indices.push_back(static_cast<std::uint32_t>(i));
  };
  const auto strip = static_cast<std::size_t>(sectors) + 1;
  for (std::size_t a = 0; a + strip < points.size(); ++a) {
    if (a % strip == strip - 1) continue;
    add(a, a + 1, a + strip);
    add(a + 1, a + strip + 1, a + strip);
  }
  return mesh;
}

std::vector<std::byte> ground_texels(int size) {
  std::vector<std::byte> texels;
  texels.reserve(4 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double u = (column + 0.5) / size, v = (row + 0.5) / size;
      const double x = u * tiles, y = v * tiles;
      const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
      const double to_joint = std::min({x - i, i + 1 - x, y - j, j + 1 - y});  // in tiles
      double grain = 0.0, strength = 0.5;
      for (std::uint32_t octave = 0; octave < 5; ++octave, strength *= 0.6)
        grain += strength * noise(u, v, 8u << octave, octave);
      const double shade = ((i + j) % 2 == 0 ? 0.045 : -0.045) + 0.05 * (hashed(i, j, 77) - 0.5);
      const double joint = 1.0 - 0.38 * std::clamp(1.0 - (to_joint - 0.006) / 0.008, 0.0, 1.0);
      const double level = (0.47 + shade * 0.9 + 0.022 * grain) * joint;
      for (const double tint : {1.02, 1.0, 0.965}) {
        const double value = linear_to_srgb(std::clamp(level * tint, 0.0, 1.0));
        texels.push_back(static_cast<std::byte>(std::lround(255.0 * value)));
      }
      texels.push_back(std::byte{255});
    }
  }
  return texels;
}

}  // namespace aspic
