#include "gpu/vertex_array.h"

#include <glad/gl.h>

#include <cassert>

namespace aspic::gl {

VertexArray VertexArray::without_inputs(Context& context) {
  VertexArray result;
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  result.name_ = Name(context, id, [](std::uint32_t owned) { glDeleteVertexArrays(1, &owned); });
  return result;
}

VertexArray VertexArray::create(std::span<const Attribute> attributes, const Buffer* indices) {
  assert(!attributes.empty());
  VertexArray result = without_inputs(*attributes.front().buffer->context());
  result.bind();
  for (const Attribute& a : attributes) {
    assert(a.buffer && a.components >= 1 && a.components <= 4);
    glBindBuffer(GL_ARRAY_BUFFER, a.buffer->id());
    glEnableVertexAttribArray(a.location);
    glVertexAttribPointer(a.location, a.components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(a.stride),
                          reinterpret_cast<const void*>(static_cast<std::uintptr_t>(a.offset)));
  }
  if (indices) glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices->id());
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  return result;
}

void VertexArray::bind() const {
  glBindVertexArray(id());
}

}  // namespace aspic::gl
