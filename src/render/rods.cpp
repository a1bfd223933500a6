#include "render/rods.h"

#include <glad/gl.h>

#include <cmath>

#include "render/layout.h"
#include "render/terrain_mesh.h"

namespace aspic {
namespace {

constexpr int sectors = 20;

std::array<float, 4> four(const Vec3& v, float w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), w};
}

void add_tube(TubeMesh& mesh, const Vec3& from, const Vec3& to, double radius) {
  const Vec3 axis = (1.0 / length(to - from)) * (to - from);
  const Vec3 aside = std::abs(axis.y) > 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 across = cross(aside, axis);
  const Vec3 u = (1.0 / length(across)) * across, v = cross(axis, u);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int s = 0; s <= sectors; ++s) {
    const double angle = 2.0 * 3.14159265358979323846 * s / sectors;
    const Vec3 n = std::cos(angle) * u + std::sin(angle) * v;
    for (const Vec3& end : {from, to}) {
      mesh.vertices.push_back(four(end + radius * n, 1.0f));
      mesh.normals.push_back(four(n, 0.0f));
    }
    if (s == 0) continue;
    const std::uint32_t before = first + 2 * static_cast<std::uint32_t>(s - 1), here = before + 2;
    mesh.indices.insert(mesh.indices.end(), {before, here, here + 1, before, here + 1, before + 1});
  }
}

void add_knob(TubeMesh& mesh, const Vec3& centre, double radius) {
  const Mesh sphere = sphere_mesh(sectors / 2, sectors);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const std::array<float, 4>& p : sphere.vertices) {
    const Vec3 n = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    mesh.vertices.push_back(four(centre + radius * n, 1.0f));
    mesh.normals.push_back(four(n, 0.0f));
  }
  for (const std::uint32_t i : sphere.indices) mesh.indices.push_back(first + i);
}

}  // namespace

TubeMesh rod_mesh(const Model& model) {
  TubeMesh mesh;
  for (const Body& body : model.bodies) {
    for (const Rod& rod : body.rods) {
      add_tube(mesh, rod.from, rod.to, rod.radius);
      add_knob(mesh, rod.from, rod.radius);
      add_knob(mesh, rod.to, rod.radius);
    }
  }
  return mesh;
}

Result<Rods> Rods::create(gl::Context& context, const Model& model) {
  const TubeMesh mesh = rod_mesh(model);
  Rods rods;
  gl::BufferFiller fill(context);
  fill(rods.vertices_, "rods", mesh.vertices);
  fill(rods.normals_, "rods' normals", mesh.normals);
  fill(rods.indices_, "rods' indices", mesh.indices);
  ASPIC_CHECK(fill.status());
  rods.index_count_ = static_cast<int>(mesh.indices.size());
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &rods.vertices_},
                                      {ATTRIBUTE_NORMAL, &rods.normals_}};
  rods.array_ = gl::VertexArray::create(attributes, &rods.indices_);
  return rods;
}

void Rods::draw_triangles() const {
  array_.bind();
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void Rods::draw(const RenderPrograms& programs) const {
  if (index_count_ == 0) return;
  programs.rods.set(LOCATION_BASE_COLOUR, std::array{0.94f, 0.94f, 0.94f, 1.0f});
  glUseProgram(programs.rods.id());
  draw_triangles();
}

void Rods::draw_into_light(const RenderPrograms& programs, int light) const {
  if (index_count_ == 0) return;
  programs.light_surface.set(LOCATION_LIGHT, light);
  glUseProgram(programs.light_surface.id());
  draw_triangles();
}

}  // namespace aspic
