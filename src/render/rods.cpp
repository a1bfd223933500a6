#include "render/rods.h"

#include <cmath>

#include "render/terrain_mesh.h"

namespace aspic {
namespace {

constexpr int sectors = 20;

void add_tube(Mesh& mesh, const Vec3& from, const Vec3& to, double radius) {
  const Vec3 axis = (1.0 / length(to - from)) * (to - from);
  const Vec3 aside = std::abs(axis.y) > 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 across = cross(aside, axis);
  const Vec3 u = (1.0 / length(across)) * across, v = cross(axis, u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int s = 0; s <= sectors; ++s) {
    const double angle = 2.0 * 3.14159265358979323846 * s / sectors;
    const Vec3 n = std::cos(angle) * u + std::sin(angle) * v;
    for (const Vec3& end : {from, to}) {
      mesh.vertices.push_back(four(end + radius * n, 1.0));
      mesh.normals.push_back(four(n, 0.0));
    }
    if (s == 0) continue;
    const std::uint32_t before = first + 2 * static_cast<std::uint32_t>(s - 1), here = before + 2;
    mesh.indices.insert(mesh.indices.end(), {before, here, here + 1, before, here + 1, before + 1});
  }
}

void add_knob(Mesh& mesh, const Vec3& center, double radius) {
  const Mesh sphere = sphere_mesh(sectors / 2, sectors);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const std::array<float, 4>& p : sphere.vertices) {
    const Vec3 n = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    mesh.vertices.push_back(four(center + radius * n, 1.0));
    mesh.normals.push_back(four(n, 0.0));
  }
  for (const std::uint32_t i : sphere.indices) mesh.indices.push_back(first + i);
}

}  // namespace

Mesh rod_mesh(const Model& model) {
  Mesh mesh;
  for (const Body& body : model.bodies) {
    for (const Rod& rod : body.rods) {
      add_tube(mesh, rod.from, rod.to, rod.radius);
      add_knob(mesh, rod.from, rod.radius);
      add_knob(mesh, rod.to, rod.radius);
    }
  }
  return mesh;
}

}  // namespace aspic
