#pragma once
// What the bodies cover, seen from the sun and from straight above.
#include <array>
#include <optional>

#include "aspic/scene.h"
#include "render/model_buffers.h"
#include "render/targets.h"

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

/// What light maps show of a model, as far as images differ.
struct LightLook {
  std::uint64_t state = 0;  ///< a number that another state does not have
  std::uint64_t step = 0;   ///< of it: balls turn by it
  DrawSettings draw;
  CutSettings cut;
  bool coarse = false;  ///< bodies' skins are
  friend bool operator==(const LightLook&, const LightLook&) = default;
};

class LightMaps {
 public:
  /// Error (scene_rejected, no_device): those of textures and framebuffers.
  static Result<LightMaps> create(gl::Context& context);

  /// Draws what a view shows of the bodies into both maps. The frame block must be bound; binds the bounds'
  /// block and both maps to their places.
  void render(const RenderPrograms& programs, const ModelBuffers& model, const DeviceState& state,
              const ViewSettings& view);
  /// Whether the maps drawn last, of the model's boxes as they are, look like this; takes note of the look,
  /// to be drawn if not. Without a look they are to be drawn.
  bool hold(const std::optional<LightLook>& look);
  /// Binds them as render() does, as they were drawn last.
  void bind(const ModelBuffers& model) const;
  /// Puts empty maps in their places: nothing keeps any light off.
  void leave_out(const ModelBuffers& model);

 private:
  std::array<DrawableImage, LIGHTS> maps_;
  std::optional<LightLook> look_;
  DrawableImage empty_;
};

}  // namespace aspic
