#include "gpu/vertex_array.h"

#include <glad/gl.h>

#include <cassert>
#include <utility>

namespace aspic::gl {

VertexArray VertexArray::create(std::span<const Attribute> attributes, const Buffer* indices) {
  VertexArray result;
  glGenVertexArrays(1, &result.id_);
  glBindVertexArray(result.id_);
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

VertexArray::~VertexArray() {
  if (id_) glDeleteVertexArrays(1, &id_);
}

VertexArray::VertexArray(VertexArray&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void VertexArray::bind() const {
  glBindVertexArray(id_);
}

}  // namespace aspic::gl
