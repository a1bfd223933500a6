#pragma once
// What lies under the cursor: an image of identities around it, read back without waiting for it.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "aspic/scene.h"
#include "base/result.h"
#include "device/device_state.h"
#include "gpu/context.h"
#include "gpu/pixel_ring.h"
#include "render/layout.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "render/section.h"
#include "render/targets.h"

namespace aspic {

/// A place in a view of width × height pixels, both > 0, from the left and the top.
struct PickPlace {
  double x = 0.0, y = 0.0;
  double width = 1.0, height = 1.0;
};

enum class PickKind { particle = PICK_PARTICLE, ball = PICK_BALL, terrain = PICK_TERRAIN };

/// What was found.
struct Picked {
  PickKind kind = PickKind::particle;
  std::uint32_t index = 0;  ///< of the model's particles, balls or terrains
  Vec3 point;               ///< where the sight line meets it [m]
  double distance = 0.0;    ///< from the eye along the camera's axis [m]
};

/// The answer to a request.
struct PickAnswer {
  std::uint64_t request = 0;  ///< 0: none has been answered yet
  std::optional<Picked> what;
};

/// Half the side of the image: how far from the cursor a particle or ball is still meant [pixels].
inline constexpr int pick_reach = 12;

/// Draws the images and reads them back. Its context must outlive it and be current.
class Picker {
 public:
  /// Errors: those of Texture.
  static Result<std::unique_ptr<Picker>> create(const std::shared_ptr<RenderProgram::Source>& source);
  Picker(const Picker&) = delete;
  Picker& operator=(const Picker&) = delete;

  /// Queues the image around a place of an image whose block was `frame`. Particles are discs at least three
  /// pixels in radius; a body that is drawn solid is its skin, each point of it representing the nearest
  /// particle there, and hides what lies behind it, as terrain and balls do; goal nets and glass do not. What
  /// a cut takes away is not there; the section it leaves, if `section` is not null, is as the skin. Changes
  /// the frame block's binding and leaves OpenGL's state as Renderer::draw does.
  void submit(std::uint64_t request, const Model& model, const ModelBuffers& buffers,
              const DeviceState& state, const ViewSettings& view, const SectionPainter* section,
              const render_layout::Frame& frame, const PickPlace& place);

  /// The newest answer that has arrived; never waits. The nearest particle or ball within pick_reach of the
  /// place, the nearer to the eye of two as near; else the terrain there; else nothing.
  const PickAnswer& answer();
  /// Forgets requests under way and the answer, whose indices mean another model's.
  void forget();

 private:
  static constexpr int side = 2 * pick_reach + 1;
  static constexpr std::size_t capacity = 3;
  /// An image on its way back.
  struct Slot {
    gl::Name buffer;
    gl::Fence fence;
    std::uint64_t request = 0;
    render_layout::Frame frame = {};
  };
  explicit Picker(gl::Context& context) : context_(context) {}
  void draw_image(const Model& model, const ModelBuffers& buffers, const DeviceState& state,
                  const ViewSettings& view, const SectionPainter* section) const;
  void draw_terrain(const Model& model, std::uint64_t step) const;
  void read(Slot& slot);

  gl::Context& context_;
  RenderProgram surface_, particles_, balls_, terrain_;
  gl::Buffer frame_;
  gl::VertexArray nothing_;
  DrawableImage image_;
  std::array<Slot, capacity> slots_ = {};
  std::size_t first_ = 0, pending_ = 0;
  PickAnswer answer_;
};

}  // namespace aspic
