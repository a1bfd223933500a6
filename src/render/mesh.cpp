#include "render/mesh.h"

#include <glad/gl.h>

#include "render/layout.h"

namespace aspic {

Result<DeviceMesh> DeviceMesh::create(gl::Context& context, const std::string& name, const Mesh& mesh) {
  DeviceMesh made;
  ASPIC_TRY(made.vertices_, gl::Buffer::of(context, name, mesh.vertices));
  ASPIC_TRY(made.normals_, gl::Buffer::of(context, name + " normals", mesh.normals));
  ASPIC_TRY(made.indices_, gl::Buffer::of(context, name + " indices", mesh.indices));
  made.index_count_ = static_cast<int>(mesh.indices.size());
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &made.vertices_},
                                      {ATTRIBUTE_NORMAL, &made.normals_}};
  made.array_ =
      gl::VertexArray::create(std::span(attributes).first(mesh.normals.empty() ? 1 : 2), &made.indices_);
  return made;
}

void DeviceMesh::draw() const {
  if (empty()) return;
  array_.bind();
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace aspic
