#pragma once
// What the bodies cover, seen from the sun and from straight above.
#include <array>

#include "render/model_buffers.h"
#include "render/targets.h"
#include "scene/scene.h"

namespace aspic {

/// Radius that particles are drawn with [m]: a share of the spacing.
double particle_radius(double spacing);
/// Radius that springs of a type are drawn with [m].
double spring_radius(double spacing, SpringType type);
/// Whether springs of the type are drawn in their type's manner.
bool draws(const DrawSettings& draw, SpringType type);
/// Whether springs of any type are.
inline bool draws_springs(const DrawSettings& draw) {
  return draw.structural || draw.shear || draw.bending;
}
/// Whether the run is drawn as the cords of a net, which take the place of a surface: structural
/// springs, unless they are drawn as such.
bool draws_as_cord(const DrawSettings& draw, const SpringRun& run);
/// Whether balls are drawn: among surfaces, and among particles.
bool draws_balls(const DrawSettings& draw);

class LightMaps {
 public:
  /// Error (scene_rejected, no_device): those of textures and framebuffers.
  static Result<LightMaps> create(gl::Context& context);

  /// Draws what a view shows of the bodies into both maps. The frame block must be bound; binds the bounds'
  /// block and both maps to their places.
  void render(const RenderPrograms& programs, const ModelBuffers& model, const DeviceState& state,
              const ViewSettings& view);
  /// Puts empty maps in their places: nothing keeps any light off.
  void leave_out(const ModelBuffers& model);

 private:
  std::array<DrawableImage, LIGHTS> maps_;
  DrawableImage empty_;
};

}  // namespace aspic
