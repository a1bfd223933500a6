#pragma once
// Ground, balls and bowls.
#include <vector>

#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/camera.h"
#include "render/programs.h"

namespace aspic {

class TerrainPainter {
 public:
  /// Makes meshes and the ground's texture. Error (scene_rejected): no device memory.
  static Result<TerrainPainter> create(gl::Context& context);

  /// Solid balls, and planes as seen from their free side; with the shadows that light maps hold, or without.
  void draw_solid(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                  const CameraSettings& camera, const Camera& lens, bool shadows) const;
  /// The far walls of bowls, before the bodies.
  void draw_far_glass(const RenderPrograms& programs, const std::vector<Terrain>& terrain) const;
  /// After the bodies: the near walls of bowls, and planes seen through from behind.
  void draw_before_bodies(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                          const CameraSettings& camera, const Camera& lens) const;

 private:
  /// Which planes, and how.
  enum class Planes { solid, shadowed, from_behind };
  void draw_planes(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                   const CameraSettings& camera, const Camera& lens, Planes planes) const;
  void draw_bowls(const RenderPrograms& programs, const std::vector<Terrain>& terrain, bool far_side) const;
  gl::Texture ground_;
  gl::Buffer square_vertices_, square_indices_, sphere_vertices_, sphere_indices_;
  gl::VertexArray square_, sphere_;
  int sphere_index_count_ = 0;
};

}  // namespace aspic
