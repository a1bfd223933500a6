#pragma once
// What the driver says of a linked program, for tests of layouts.
#include <glad/gl.h>

#include <optional>
#include <string>
#include <string_view>

#include "gpu/program.h"

namespace aspic::testing {

/// Names as glGetProgramResourceIndex has them; nothing for an inactive name. Sizes in bytes.
class Reflection {
 public:
  explicit Reflection(const gl::Program& program) : id_(program.id()) {}

  /// Active storage blocks.
  int storage_block_count() const {
    GLint count = 0;
    glGetProgramInterfaceiv(id_, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
    return count;
  }
  std::optional<int> storage_block_binding(std::string_view block) const {
    return property(GL_SHADER_STORAGE_BLOCK, block, GL_BUFFER_BINDING);
  }
  std::optional<int> uniform_block_binding(std::string_view block) const {
    return property(GL_UNIFORM_BLOCK, block, GL_BUFFER_BINDING);
  }
  /// Least bytes a buffer bound to the block must have; an unsized array counts one element.
  std::optional<int> storage_block_data_size(std::string_view block) const {
    return property(GL_SHADER_STORAGE_BLOCK, block, GL_BUFFER_DATA_SIZE);
  }
  std::optional<int> uniform_block_data_size(std::string_view block) const {
    return property(GL_UNIFORM_BLOCK, block, GL_BUFFER_DATA_SIZE);
  }
  /// Offset of a member of a storage block, e.g. "Block.items[0].velocity".
  std::optional<int> buffer_variable_offset(std::string_view name) const {
    return property(GL_BUFFER_VARIABLE, name, GL_OFFSET);
  }
  /// Stride of an array of basic type, e.g. "Block.values[0]"; 0 for what is no array.
  std::optional<int> buffer_variable_array_stride(std::string_view name) const {
    return property(GL_BUFFER_VARIABLE, name, GL_ARRAY_STRIDE);
  }
  /// Stride of the outermost array that the member lies in, e.g. of structs.
  std::optional<int> buffer_variable_top_level_stride(std::string_view name) const {
    return property(GL_BUFFER_VARIABLE, name, GL_TOP_LEVEL_ARRAY_STRIDE);
  }
  /// Offset of a member of a uniform block, e.g. "Block.classes[0].stiffness".
  std::optional<int> uniform_offset(std::string_view name) const {
    return property(GL_UNIFORM, name, GL_OFFSET);
  }
  std::optional<int> uniform_array_stride(std::string_view name) const {
    return property(GL_UNIFORM, name, GL_ARRAY_STRIDE);
  }
  /// Location of a uniform outside blocks.
  std::optional<int> uniform_location(std::string_view name) const {
    return property(GL_UNIFORM, name, GL_LOCATION);
  }

 private:
  std::optional<int> property(GLenum interface, std::string_view name, GLenum asked) const {
    const GLuint index = glGetProgramResourceIndex(id_, interface, std::string(name).c_str());
    if (index == GL_INVALID_INDEX) return std::nullopt;
    GLint value = 0;
    glGetProgramResourceiv(id_, interface, index, 1, &asked, 1, nullptr, &value);
    return value;
  }
  GLuint id_;
};

}  // namespace aspic::testing
