#include "render/terrain_painter.h"

#include <glad/gl.h>

#include <algorithm>

#include "model/terrain.h"
#include "render/layout.h"
#include "render/terrain_mesh.h"

namespace aspic {
namespace {

constexpr int ground_size = 512;
constexpr int sphere_rings = 64;
constexpr int sphere_sectors = 128;

std::array<float, 4> four(const Vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

bool is_plane(const Terrain& t) {
  return t.shape == TerrainShape::plane || t.shape == TerrainShape::tilted_plane;
}

}  // namespace

Result<TerrainPainter> TerrainPainter::create(gl::Context& context) {
  TerrainPainter painter;
  auto ground = gl::Texture::create(
      context, "ground",
      {.width = ground_size, .height = ground_size, .mipmaps = true, .wrap = gl::Wrap::repeat});
  if (!ground) return ground.error();
  ground->upload(ground_texels(ground_size));
  ground->generate_mipmaps();
  painter.ground_ = std::move(*ground);

  gl::BufferFiller fill(context);
  const Mesh square = square_mesh();
  const Mesh sphere = sphere_mesh(sphere_rings, sphere_sectors);
  fill(painter.square_vertices_, "square", square.vertices);
  fill(painter.square_indices_, "square indices", square.indices);
  fill(painter.sphere_vertices_, "sphere", sphere.vertices);
  fill(painter.sphere_indices_, "sphere indices", sphere.indices);
  if (!fill.status()) return fill.status().error();
  painter.sphere_index_count_ = static_cast<int>(sphere.indices.size());
  const gl::Attribute of_square[] = {{ATTRIBUTE_POSITION, &painter.square_vertices_}};
  const gl::Attribute of_sphere[] = {{ATTRIBUTE_POSITION, &painter.sphere_vertices_}};
  painter.square_ = gl::VertexArray::create(of_square, &painter.square_indices_);
  painter.sphere_ = gl::VertexArray::create(of_sphere, &painter.sphere_indices_);
  return painter;
}

void TerrainPainter::draw_solid(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                const CameraSettings& camera, const Camera& lens, bool shadows) const {
  ground_.bind(UNIT_GROUND);
  glEnable(GL_CULL_FACE);
  glUseProgram(programs.sphere.id());
  sphere_.bind();
  for (const Terrain& t : terrain) {
    if (t.shape != TerrainShape::sphere) continue;
    programs.sphere.set(LOCATION_SPHERE, four(t.point, t.radius));
    glDrawElements(GL_TRIANGLES, sphere_index_count_, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
  draw_planes(programs, terrain, camera, lens, shadows ? Planes::shadowed : Planes::solid);
}

void TerrainPainter::draw_planes(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                 const CameraSettings& camera, const Camera& lens, Planes planes) const {
  const bool from_behind = planes == Planes::from_behind;
  square_.bind();
  for (const Terrain& t : terrain) {
    if (!is_plane(t) || (signed_distance(t, camera.position) < 0.0) != from_behind) continue;
    if (from_behind) {
      glEnable(GL_BLEND);
      glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    // The square lies around what the camera looks at and reaches as far as it sees.
    const Vec3 middle = camera.target - signed_distance(t, camera.target) * t.normal;
    const double reach = 14.0 * static_cast<double>(lens.target_distance());
    for (const gl::Program* program : {&programs.plane, &programs.shadowed_plane}) {
      program->set(LOCATION_PLANE_POINT, four(middle, reach));
      program->set(LOCATION_PLANE_NORMAL, four(t.normal, 0.0));
    }
    glUseProgram(programs.plane.id());
    glDrawElements(GL_TRIANGLES, 6, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_BLEND);
    if (planes != Planes::shadowed) continue;
    // Shadows cost several times the plain ground, and cover little of it.
    glUseProgram(programs.shadowed_plane.id());
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-2.0f, -64.0f);
    glDrawElementsInstanced(GL_TRIANGLES, 6, GL_UNSIGNED_INT, nullptr, LIGHTS);
    glPolygonOffset(0.0f, 0.0f);
    glDisable(GL_POLYGON_OFFSET_FILL);
  }
  glBindVertexArray(0);
}

void TerrainPainter::draw_bowls(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                bool far_side) const {
  if (std::ranges::none_of(terrain, [](const Terrain& t) { return t.shape == TerrainShape::bowl; })) return;
  glEnable(GL_CULL_FACE);
  glCullFace(far_side ? GL_FRONT : GL_BACK);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glUseProgram(programs.glass.id());
  programs.glass.set(LOCATION_SIDE, far_side ? 1 : 0);
  sphere_.bind();
  for (const Terrain& t : terrain) {
    if (t.shape != TerrainShape::bowl) continue;
    programs.glass.set(LOCATION_SPHERE, four(t.point, t.radius));
    glDrawElements(GL_TRIANGLES, sphere_index_count_, GL_UNSIGNED_INT, nullptr);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glCullFace(GL_BACK);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void TerrainPainter::draw_far_glass(const RenderPrograms& programs,
                                    const std::vector<Terrain>& terrain) const {
  draw_bowls(programs, terrain, true);
}

void TerrainPainter::draw_before_bodies(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                        const CameraSettings& camera, const Camera& lens) const {
  draw_bowls(programs, terrain, false);
  draw_planes(programs, terrain, camera, lens, Planes::from_behind);
}

}  // namespace aspic
