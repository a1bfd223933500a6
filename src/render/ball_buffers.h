#pragma once
// What drawing needs of a model's balls, and how far each has turned.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/result.h"
#include "device/device_state.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/programs.h"

namespace aspic {

/// Buffers of one model's balls. Their context must outlive them and be current. A state does not say how a
/// ball is turned, only how fast it turns: from image to image each is turned by the angular velocity it
/// has in the later one, from the frame it started in. Nothing but the image depends on it.
class BallBuffers {
 public:
  /// Error (scene_rejected): no device memory.
  static Result<BallBuffers> create(gl::Context& context, const Model& model);

  /// Turns the balls to where they are at state.step, and adds those in sight to the box of each light. Going
  /// back in time starts again, unturned. The frame block must be bound.
  void prepare(const RenderPrograms& programs, const DeviceState& state, const gl::Buffer& bounds);

  /// The balls are turned like this at that step: prepare() goes on from there.
  void set_turns(const std::vector<std::array<float, 4>>& turns, std::uint64_t step);

  /// Draws what has been launched, as points that the program makes balls of.
  void draw(const gl::Program& program, const DeviceState& state) const;

  /// Whether the state brings any.
  bool shows(const DeviceState& state) const { return count_ > 0 && state.balls && state.balls->id() != 0; }
  std::uint32_t count() const { return count_; }
  /// Each ball's unit quaternion x, y, z, w, from its own frame to the world.
  const gl::Buffer& turns() const { return turns_; }

 private:
  BallBuffers() = default;

  std::uint32_t count_ = 0;
  double timestep_ = 0.0;
  std::optional<std::uint64_t> turned_to_;
  gl::Buffer turns_, colors_;
};

}  // namespace aspic
