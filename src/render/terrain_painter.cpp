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
    const Mesh mesh = terrain_mesh(t, mesh_rings, mesh_sectors);
    made.extent = extent_of(mesh);
    ASPIC_TRY(made.mesh, DeviceMesh::create(context, "terrain", mesh));
  }
  meshes_ = std::move(meshes);
  return {};
}

void TerrainPainter::draw_meshes(const RenderProgram& program, const std::vector<Terrain>& terrain,
                                 bool glass) const {
  for (std::size_t i = 0; i < terrain.size(); ++i) {
    const PlacedMesh& placed = meshes_[i];
    if (placed.mesh.empty() || terrain_row(terrain[i].shape).glass != glass) continue;
    glUseProgram(program.id());
    if (!glass) aspic::set_terrain(program, terrain[i]);
    program.set(LOCATION_OFFSET, four(terrain[i].geometry.vectors[0] - placed.place, 0.0));
    placed.mesh.draw();
  }
}

void TerrainPainter::draw_solid(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                const CameraSettings& camera, const Camera& lens, bool shadows,
                                const ImageTargets& targets) const {
  draw_solid_meshes(programs, terrain);
  draw_planes(programs, terrain, camera, lens, shadows ? Planes::shadowed : Planes::solid, &targets);
}

void TerrainPainter::draw_shadows(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                  const CameraSettings& camera, const Camera& lens,
                                  const ImageTargets& targets) const {
  draw_solid_meshes(programs, terrain);
  draw_planes(programs, terrain, camera, lens, Planes::shadows_alone, &targets);
}

void TerrainPainter::draw_solid_meshes(const RenderPrograms& programs,
                                       const std::vector<Terrain>& terrain) const {
  ground_.bind(UNIT_GROUND);
  glEnable(GL_CULL_FACE);
  draw_meshes(programs.solid, terrain, false);
  glDisable(GL_CULL_FACE);
}

namespace {

/// Where sight lines come from.
Vec3 eye_of(const CameraSettings& camera, const Camera& lens) {
  const glm::vec3& far_eye = lens.eye();
  return lens.orthographic() ? Vec3{far_eye.x, far_eye.y, far_eye.z} : camera.position;
}

/// Whether a place is behind a plane.
bool behind(const FlatPart& flat, const Vec3& place) {
  return dot(flat.normal, place - flat.point) < 0.0;
}

}  // namespace

bool TerrainPainter::add_changing(const std::vector<Terrain>& terrain, const CameraSettings& camera,
                                  const Camera& lens, bool shadows, MovingThings& things) const {
  bool all = true;
  for (std::size_t i = 0; i < terrain.size(); ++i) {
    const TerrainShapeRow& row = terrain_row(terrain[i].shape);
    if (row.surface && (shadows || row.glass)) {
      const Vec3 by = terrain[i].geometry.vectors[0] - meshes_[i].place;
      things.extents.push_back(meshes_[i].extent.moved({by.x, by.y, by.z}));
    }
    if (!row.flat) continue;
    const FlatPart flat = row.flat(terrain[i].geometry);
    if (behind(flat, eye_of(camera, lens))) all = false;
    if (shadows) things.shadowed.push_back(flat);
  }
  return all;
}

void TerrainPainter::draw_planes(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                                 const CameraSettings& camera, const Camera& lens, Planes planes,
                                 const ImageTargets* targets) const {
  const bool from_behind = planes == Planes::from_behind;
  for (const Terrain& t : terrain) {
    const TerrainShapeRow& row = terrain_row(t.shape);
    if (!row.flat) continue;
    const FlatPart flat = row.flat(t.geometry);
    const auto above = [&](const Vec3& x) { return dot(flat.normal, x - flat.point); };
    if (behind(flat, eye_of(camera, lens)) != from_behind) continue;
    const bool cut = row.surface != nullptr;
    const auto& [plain, shadowed] = cut ? programs.cut_plane : programs.plane;
    if (from_behind) {
      glEnable(GL_BLEND);
      glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    // The square lies around what the camera looks at and reaches as far as it sees.
    const Vec3 middle = camera.target - above(camera.target) * flat.normal;
    const double reach = 28.0 * static_cast<double>(lens.target_distance());
    const auto place = [&](const RenderProgram& program) {
      program.set(LOCATION_PLANE_POINT, four(middle, reach));
      program.set(LOCATION_PLANE_NORMAL, four(flat.normal, 0.0));
    };
    if (planes != Planes::shadows_alone) {
      place(plain);
      if (cut) aspic::set_terrain(plain, t);
      glUseProgram(plain.id());
      square_.draw();
    }
    glDisable(GL_BLEND);
    if (planes == Planes::solid || from_behind) continue;
    place(shadowed);
    if (cut) aspic::set_terrain(shadowed, t);
    for (const RenderProgram& shade : programs.shade) place(shade);
    draw_shadowed(programs, shadowed, *targets);
  }
  glBindVertexArray(0);
}

void TerrainPainter::draw_shadowed(const RenderPrograms& programs, const gl::Program& shadowed,
                                   const ImageTargets& targets) const {
  // Shadows cost several times the plain ground, and cover little of it.
  targets.shade.framebuffer.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  for (int light = 0; light < LIGHTS; ++light) {
    const gl::Program& shade = programs.shade[static_cast<std::size_t>(light)];
    shade.set(LOCATION_LIGHT, light);
    glUseProgram(shade.id());
    square_.draw();
  }
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  targets.samples.framebuffer.bind();
  targets.shade.color.bind(UNIT_SHADE);
  glUseProgram(shadowed.id());
  glEnable(GL_POLYGON_OFFSET_FILL);
  for (int light = 0; light < LIGHTS; ++light) {
    // Each a little behind the one before: what both squares hold is drawn once.
    const auto nearer = static_cast<float>(LIGHTS - light);
    glPolygonOffset(-nearer, -32.0f * nearer);
    shadowed.set(LOCATION_LIGHT, light);
    square_.draw();
  }
  glPolygonOffset(0.0f, 0.0f);
  glDisable(GL_POLYGON_OFFSET_FILL);
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
  draw_planes(programs, terrain, camera, lens, Planes::from_behind, nullptr);
}

}  // namespace aspic
