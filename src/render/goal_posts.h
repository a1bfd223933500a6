#pragma once
// The frame that goal nets hang on: posts at the four corners and a bar around the top, drawn as tubes.
#include <array>
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/programs.h"

namespace aspic {

struct TubeMesh {
  std::vector<std::array<float, 4>> vertices;  ///< position; the last component is 1
  std::vector<std::array<float, 4>> normals;   ///< unit; the last component is 0
  std::vector<std::uint32_t> indices;          ///< three per triangle, anticlockwise from outside
};

/// The tubes of all goal nets, where their pinned particles are at the start. Their radius is a fiftieth of
/// the net's least side: 4 cm for a net 2 m deep.
TubeMesh goal_post_mesh(const Model& model);

/// The same on the device. Its context must outlive it and be current.
class GoalPosts {
 public:
  /// Error (scene_rejected): no device memory.
  static Result<GoalPosts> create(gl::Context& context, const Model& model);

  /// Draws them, lit; the frame block must be bound.
  void draw(const RenderPrograms& programs) const;
  /// Draws them into the map of a light.
  void draw_into_light(const RenderPrograms& programs, int light) const;

 private:
  GoalPosts() = default;
  void draw_triangles() const;

  int index_count_ = 0;
  gl::Buffer vertices_, normals_, indices_;
  gl::VertexArray array_;
};

}  // namespace aspic
