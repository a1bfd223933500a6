#pragma once
// The rods that bodies hang on, drawn as tubes with round ends.
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

/// The rods of all bodies.
TubeMesh rod_mesh(const Model& model);

/// The same on the device. Its context must outlive it and be current.
class Rods {
 public:
  /// Error (scene_rejected): no device memory.
  static Result<Rods> create(gl::Context& context, const Model& model);

  /// Draws them, lit; the frame block must be bound.
  void draw(const RenderPrograms& programs) const;
  /// Draws them into the map of a light.
  void draw_into_light(const RenderPrograms& programs, int light) const;

 private:
  Rods() = default;
  void draw_triangles() const;

  int index_count_ = 0;
  gl::Buffer vertices_, normals_, indices_;
  gl::VertexArray array_;
};

}  // namespace aspic
