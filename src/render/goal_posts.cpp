#include "render/goal_posts.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>

#include "model/goal_net.h"
#include "render/layout.h"
#include "render/terrain_mesh.h"

namespace aspic {
namespace {

constexpr int sectors = 20;
constexpr double radius_share = 0.02;

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

void add_frame(TubeMesh& mesh, const Model& model, const Body& net) {
  const auto corner = [&](bool front, bool top, bool right) {
    const auto [nw, nh, nl] = net.lattice;
    const auto index = net_index(net.lattice, front ? nw - 1 : 0, top ? nh - 1 : 0, right ? nl - 1 : 0);
    return model.initial_position[net.first_particle + *index];
  };
  const Vec3 size = corner(true, true, true) - corner(false, false, false);
  const double radius = radius_share * std::min({size.x, size.y, size.z});
  for (const bool front : {false, true}) {
    for (const bool right : {false, true}) {
      add_tube(mesh, corner(front, false, right), corner(front, true, right), radius);
      add_knob(mesh, corner(front, false, right), radius);
      add_knob(mesh, corner(front, true, right), radius);
    }
    add_tube(mesh, corner(front, true, false), corner(front, true, true), radius);
    add_tube(mesh, corner(false, true, front), corner(true, true, front), radius);
  }
}

}  // namespace

TubeMesh goal_post_mesh(const Model& model) {
  TubeMesh mesh;
  for (const Body& body : model.bodies)
    if (body.goal) add_frame(mesh, model, body);
  return mesh;
}

Result<GoalPosts> GoalPosts::create(gl::Context& context, const Model& model) {
  const TubeMesh mesh = goal_post_mesh(model);
  GoalPosts posts;
  gl::BufferFiller fill(context);
  fill(posts.vertices_, "goal posts", mesh.vertices);
  fill(posts.normals_, "goal posts' normals", mesh.normals);
  fill(posts.indices_, "goal posts' indices", mesh.indices);
  if (!fill.status()) return fill.status().error();
  posts.index_count_ = static_cast<int>(mesh.indices.size());
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &posts.vertices_},
                                      {ATTRIBUTE_NORMAL, &posts.normals_}};
  posts.array_ = gl::VertexArray::create(attributes, &posts.indices_);
  return posts;
}

void GoalPosts::draw_triangles() const {
  array_.bind();
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

void GoalPosts::draw(const RenderPrograms& programs) const {
  if (index_count_ == 0) return;
  programs.posts.set(LOCATION_BASE_COLOUR, std::array{0.94f, 0.94f, 0.94f, 1.0f});
  glUseProgram(programs.posts.id());
  draw_triangles();
}

void GoalPosts::draw_into_light(const RenderPrograms& programs, int light) const {
  if (index_count_ == 0) return;
  programs.light_surface.set(LOCATION_LIGHT, light);
  glUseProgram(programs.light_surface.id());
  draw_triangles();
}

}  // namespace aspic
