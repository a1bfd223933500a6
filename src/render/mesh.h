#pragma once
// Triangles that never deform, and the same on the device.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "aspic/vec.h"
#include "gpu/buffer.h"
#include "gpu/vertex_array.h"

namespace aspic {

struct Mesh {
  std::vector<std::array<float, 4>> vertices;  ///< position; the last component is 1
  std::vector<std::array<float, 4>> normals;   ///< unit, outwards, the last component 0; or none at all
  std::vector<std::uint32_t> indices;          ///< three per triangle, counterclockwise from outside
};

/// A vector in single precision, as shaders take it, with its fourth component.
inline std::array<float, 4> four(const Vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

/// A mesh on the device. Its context must outlive it and be current.
class DeviceMesh {
 public:
  /// Nothing to draw.
  DeviceMesh() = default;
  /// `name` appears in errors. Error (scene_rejected): no device memory.
  static Result<DeviceMesh> create(gl::Context& context, const std::string& name, const Mesh& mesh);

  bool empty() const { return index_count_ == 0; }
  /// Draws it with the program in use.
  void draw() const;

 private:
  int index_count_ = 0;
  gl::Buffer vertices_, normals_, indices_;
  gl::VertexArray array_;
};

}  // namespace aspic
