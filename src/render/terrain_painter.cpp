#include "render/terrain_painter.h"

#include <glad/gl.h>

#include <algorithm>

#include "model/terrain.h"
#include "render/layout.h"
#include "render/terrain_mesh.h"

namespace aspic {
namespace {

constexpr int ground_size = 512;
constexpr int mesh_rings = 64;
constexpr int mesh_sectors = 128;

}  // namespace

void set_terrain(const gl::Program& program, const Terrain& terrain) {
  const Geometry<double>& g = terrain.geometry;
  for (std::size_t k = 0; k < geometry_size; ++k)
    program.set(LOCATION_TERRAIN + static_cast<int>(k), four(g.vectors[k], g.numbers[k]));
  program.set(LOCATION_TERRAIN + static_cast<int>(geometry_size), static_cast<std::uint32_t>(terrain.shape));
}

Result<TerrainPainter> TerrainPainter::create(gl::Context& context) {
  TerrainPainter painter;
  const gl::TextureSettings tiles = {
      .width = ground_size, .height = ground_size, .mipmaps = true, .wrap = gl::Wrap::repeat};
  ASPIC_TRY(painter.ground_, gl::Texture::create(context, "ground", tiles));
  painter.ground_.upload(ground_texels(ground_size));
  painter.ground_.generate_mipmaps();

  ASPIC_TRY(painter.square_, DeviceMesh::create(context, "square", square_mesh()));
  return painter;
}

Status TerrainPainter::set_terrain(gl::Context& context, const std::vector<Terrain>& terrain) {
  std::vector<PlacedMesh> meshes;
  for (const Terrain& t : terrain) {
    PlacedMesh& made = meshes.emplace_back();
    if (!terrain_row(t.shape).surface) continue;
    made.place = t.geometry.vectors[0];
    ASPIC_TRY(made.mesh, DeviceMesh::create(context, "terrain", terrain_mesh(t, mesh_rings, mesh_sectors)));
  }
  meshes_ = std::move(meshes);
  return {};
}

void TerrainPainter::draw_meshes(const gl::Program& program, const std::vector<Terrain>& terrain,
                                 bool glass) const {
  glUseProgram(program.id());
  for (std::size_t i = 0; i < terrain.size(); ++i) {
    const PlacedMesh& placed = meshes_[i];
    if (placed.mesh.empty() || terrain_row(terrain[i].shape).glass != glass) continue;
    if (!glass) aspic::set_terrain(program, terrain[i]);
    program.set(LOCATION_OFFSET, four(terrain[i].geometry.vectors[0] - placed.place, 0.0));
    placed.mesh.draw();
  }
}

void TerrainPainter::draw_solid(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                const CameraSettings& camera, const Camera& lens, bool shadows) const {
  ground_.bind(UNIT_GROUND);
  glEnable(GL_CULL_FACE);
  draw_meshes(programs.solid, terrain, false);
  glDisable(GL_CULL_FACE);
  draw_planes(programs, terrain, camera, lens, shadows ? Planes::shadowed : Planes::solid);
}

void TerrainPainter::draw_planes(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                 const CameraSettings& camera, const Camera& lens, Planes planes) const {
  const bool from_behind = planes == Planes::from_behind;
  for (const Terrain& t : terrain) {
    const TerrainShapeRow& row = terrain_row(t.shape);
    if (!row.flat) continue;
    const FlatPart flat = row.flat(t.geometry);
    const auto above = [&](const Vec3& x) { return dot(flat.normal, x - flat.point); };
    const glm::vec3& far_eye = lens.eye();
    const Vec3 eye = lens.orthographic() ? Vec3{far_eye.x, far_eye.y, far_eye.z} : camera.position;
    if ((above(eye) < 0.0) != from_behind) continue;
    const bool cut = row.surface != nullptr;
    const auto& [plain, shadowed] = cut ? programs.cut_plane : programs.plane;
    if (from_behind) {
      glEnable(GL_BLEND);
      glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    // The square lies around what the camera looks at and reaches as far as it sees.
    const Vec3 middle = camera.target - above(camera.target) * flat.normal;
    const double reach = 14.0 * static_cast<double>(lens.target_distance());
    for (const gl::Program* program : {&plain, &shadowed}) {
      program->set(LOCATION_PLANE_POINT, four(middle, reach));
      program->set(LOCATION_PLANE_NORMAL, four(flat.normal, 0.0));
      if (cut) aspic::set_terrain(*program, t);
    }
    glUseProgram(plain.id());
    square_.draw();
    glDisable(GL_BLEND);
    if (planes != Planes::shadowed) continue;
    // Shadows cost several times the plain ground, and cover little of it.
    glUseProgram(shadowed.id());
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-2.0f, -64.0f);
    square_.draw(LIGHTS);
    glPolygonOffset(0.0f, 0.0f);
    glDisable(GL_POLYGON_OFFSET_FILL);
  }
  glBindVertexArray(0);
}

void TerrainPainter::draw_glass(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                bool far_side) const {
  if (std::ranges::none_of(terrain, [](const Terrain& t) { return terrain_row(t.shape).glass; })) return;
  glEnable(GL_CULL_FACE);
  glCullFace(far_side ? GL_FRONT : GL_BACK);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  programs.glass.set(LOCATION_SIDE, far_side ? 1 : 0);
  draw_meshes(programs.glass, terrain, true);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glCullFace(GL_BACK);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void TerrainPainter::draw_far_glass(const RenderPrograms& programs,
                                    const std::vector<Terrain>& terrain) const {
  draw_glass(programs, terrain, true);
}

void TerrainPainter::draw_before_bodies(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                        const CameraSettings& camera, const Camera& lens) const {
  draw_glass(programs, terrain, false);
  draw_planes(programs, terrain, camera, lens, Planes::from_behind);
}

}  // namespace aspic
