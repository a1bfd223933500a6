#pragma once
// Which buffers feed the inputs of a vertex shader.
#include <cstdint>
#include <span>

#include "gpu/buffer.h"
#include "gpu/name.h"

namespace aspic::gl {

/// One input of a vertex shader: `components` floats per vertex from `buffer`.
struct Attribute {
  std::uint32_t location = 0;      ///< `layout(location = …) in`
  const Buffer* buffer = nullptr;  ///< must outlive every draw
  int components = 4;              ///< 1…4
  std::uint32_t stride = 16;       ///< from one vertex to the next [bytes]
  std::uint32_t offset = 0;        ///< of the first [bytes]
};

/// Owns one GL vertex array object. Movable; its context must outlive it and be current.
class VertexArray {
 public:
  /// An empty handle: id 0.
  VertexArray() = default;

  /// An array of these inputs, at least one, and, unless null, an index buffer of 32-bit indices.
  static VertexArray create(std::span<const Attribute> attributes, const Buffer* indices = nullptr);
  /// One without inputs: the shader makes its vertices from gl_VertexID.
  static VertexArray without_inputs(Context& context);

  void bind() const;
  std::uint32_t id() const { return name_.id(); }

 private:
  Name name_;
};

}  // namespace aspic::gl
