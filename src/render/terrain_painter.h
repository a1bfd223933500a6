#pragma once
// Ground, solid surfaces and glass.
#include <vector>

#include "gpu/texture.h"
#include "model/model.h"
#include "render/camera.h"
#include "render/mesh.h"
#include "render/moving_part.h"
#include "render/programs.h"
#include "render/targets.h"

namespace aspic {

/// Sets the uniform of shaders/render/drawn_terrain.glsl.
void set_terrain(const gl::Program& program, const Terrain& terrain);

class TerrainPainter {
 public:
  /// Makes the ground's texture. Error (scene_rejected): no device memory.
  static Result<TerrainPainter> create(gl::Context& context);

  /// Makes the meshes of these terrains, which are those drawn from now on. Error (scene_rejected): no device
  /// memory.
  Status set_terrain(gl::Context& context, const std::vector<Terrain>& terrain);

  /// Into the samples of `targets`, which are bound: solid surfaces, and planes as seen from their free side;
  /// with the shadows that light maps hold, or without.
  void draw_solid(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                  const CameraSettings& camera, const Camera& lens, bool shadows,
                  const ImageTargets& targets) const;
  /// Over the same without shadows: all of it that may have some.
  void draw_shadows(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                    const CameraSettings& camera, const Camera& lens, const ImageTargets& targets) const;
  /// Tells what of the terrain a state may change: surfaces, glass alone without `shadows`, and the planes
  /// that have shadows then. Whether that is all: planes seen from behind lie over everything.
  bool add_changing(const std::vector<Terrain>& terrain, const CameraSettings& camera, const Camera& lens,
                    bool shadows, MovingThings& things) const;
  /// The far walls of glass, before the bodies.
  void draw_far_glass(const RenderPrograms& programs, const std::vector<Terrain>& terrain) const;
  /// After the bodies: the near walls of glass, and planes seen through from behind.
  void draw_before_bodies(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                          const CameraSettings& camera, const Camera& lens) const;

 private:
  /// Which planes, and how.
  enum class Planes { solid, shadowed, shadows_alone, from_behind };
  void draw_planes(const RenderPrograms& programs, const std::vector<Terrain>& terrain,
                   const CameraSettings& camera, const Camera& lens, Planes planes,
                   const ImageTargets* targets) const;
  /// The squares of a plane that shadows fall on. `shadowed` is one of the two programs for it, prepared.
  void draw_shadowed(const RenderPrograms& programs, const gl::Program& shadowed,
                     const ImageTargets& targets) const;
  void draw_solid_meshes(const RenderPrograms& programs, const std::vector<Terrain>& terrain) const;
  void draw_glass(const RenderPrograms& programs, const std::vector<Terrain>& terrain, bool far_side) const;
  /// The bounded surfaces of solid terrain, or of glass.
  void draw_meshes(const RenderProgram& program, const std::vector<Terrain>& terrain, bool glass) const;
  /// The surface of one terrain; without one it is empty.
  struct PlacedMesh {
    Vec3 place;  ///< vector 0 of the geometry it was made with
    DeviceMesh mesh;
    Extent extent;
  };
  gl::Texture ground_;
  DeviceMesh square_;
  std::vector<PlacedMesh> meshes_;  ///< one for each terrain
};

}  // namespace aspic
