#include "gpu/program.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <utility>

namespace aspic::gl {
namespace {

std::string shader_log(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  GLsizei written = 0;
  if (length > 0) glGetShaderInfoLog(shader, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

std::string program_log(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  GLsizei written = 0;
  if (length > 0) glGetProgramInfoLog(program, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

std::string block_names(GLuint program, int count) {
  std::string names;
  for (int i = 0; i < count; ++i) {
    GLchar name[256];
    GLsizei length = 0;
    glGetProgramResourceName(program, GL_SHADER_STORAGE_BLOCK, static_cast<GLuint>(i), sizeof name, &length,
                             name);
    names += fmt::format("{}{}", names.empty() ? "" : ", ",
                         std::string_view(name, static_cast<std::size_t>(length)));
  }
  return names;
}

}  // namespace

Result<Program> Program::compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines) {
  const Result<FlatShader> source = library.flatten(path, defines);
  if (!source) return source.error();

  Program program;
  program.path_ = path;
  program.id_ = glCreateProgram();
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  const GLchar* text = source->text().data();
  const auto length = static_cast<GLint>(source->text().size());
  glShaderSource(shader, 1, &text, &length);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    const std::string log = source->rewrite_log(shader_log(shader));
    glDeleteShader(shader);
    return Error{ErrorCode::no_device,
                 fmt::format("{} does not compile the shader {}:\n{}", context.info().renderer, path, log)};
  }
  glAttachShader(program.id_, shader);
  glLinkProgram(program.id_);
  glDetachShader(program.id_, shader);
  glDeleteShader(shader);
  glGetProgramiv(program.id_, GL_LINK_STATUS, &ok);
  if (!ok)
    return Error{ErrorCode::no_device,
                 fmt::format("{} does not link the shader {}:\n{}", context.info().renderer, path,
                             source->rewrite_log(program_log(program.id_)))};

  glGetProgramInterfaceiv(program.id_, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES,
                          &program.storage_blocks_);
  if (program.storage_blocks_ > max_storage_blocks)
    return Error{
        ErrorCode::no_device,
        fmt::format("The shader {} uses {} storage blocks ({}), but OpenGL 4.3 guarantees {}. Put some of "
                    "them into one block.",
                    path, program.storage_blocks_, block_names(program.id_, program.storage_blocks_),
                    max_storage_blocks)};
  GLint size[3] = {};
  glGetProgramiv(program.id_, GL_COMPUTE_WORK_GROUP_SIZE, size);
  for (std::size_t i = 0; i < 3; ++i) program.group_size_[i] = static_cast<std::uint32_t>(size[i]);
  if (context.info().debug)
    glObjectLabel(GL_PROGRAM, program.id_, static_cast<GLsizei>(path.size()), path.data());
  return program;
}

Program::~Program() {
  release();
}

Program::Program(Program&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      path_(std::move(other.path_)),
      group_size_(other.group_size_),
      storage_blocks_(other.storage_blocks_) {}

Program& Program::operator=(Program&& other) noexcept {
  if (this == &other) return *this;
  release();
  id_ = std::exchange(other.id_, 0);
  path_ = std::move(other.path_);
  group_size_ = other.group_size_;
  storage_blocks_ = other.storage_blocks_;
  return *this;
}

void Program::release() {
  if (id_) glDeleteProgram(id_);
  id_ = 0;
}

void Program::set(int location, std::uint32_t value) const {
  glProgramUniform1ui(id_, location, value);
}

void Program::set(int location, std::int32_t value) const {
  glProgramUniform1i(id_, location, value);
}

void Program::set(int location, float value) const {
  glProgramUniform1f(id_, location, value);
}

void Program::set(int location, const std::array<float, 3>& value) const {
  glProgramUniform3f(id_, location, value[0], value[1], value[2]);
}

std::optional<int> Program::property(std::uint32_t interface, std::string_view name,
                                     std::uint32_t property) const {
  const GLuint index = glGetProgramResourceIndex(id_, interface, std::string(name).c_str());
  if (index == GL_INVALID_INDEX) return std::nullopt;
  GLint value = 0;
  glGetProgramResourceiv(id_, interface, index, 1, &property, 1, nullptr, &value);
  return value;
}

std::optional<int> Program::storage_block_binding(std::string_view block) const {
  return property(GL_SHADER_STORAGE_BLOCK, block, GL_BUFFER_BINDING);
}

std::optional<int> Program::uniform_block_binding(std::string_view block) const {
  return property(GL_UNIFORM_BLOCK, block, GL_BUFFER_BINDING);
}

std::optional<int> Program::storage_block_data_size(std::string_view block) const {
  return property(GL_SHADER_STORAGE_BLOCK, block, GL_BUFFER_DATA_SIZE);
}

std::optional<int> Program::uniform_block_data_size(std::string_view block) const {
  return property(GL_UNIFORM_BLOCK, block, GL_BUFFER_DATA_SIZE);
}

std::optional<int> Program::buffer_variable_offset(std::string_view name) const {
  return property(GL_BUFFER_VARIABLE, name, GL_OFFSET);
}

std::optional<int> Program::buffer_variable_array_stride(std::string_view name) const {
  return property(GL_BUFFER_VARIABLE, name, GL_ARRAY_STRIDE);
}

std::optional<int> Program::buffer_variable_top_level_stride(std::string_view name) const {
  return property(GL_BUFFER_VARIABLE, name, GL_TOP_LEVEL_ARRAY_STRIDE);
}

std::optional<int> Program::uniform_offset(std::string_view name) const {
  return property(GL_UNIFORM, name, GL_OFFSET);
}

std::optional<int> Program::uniform_array_stride(std::string_view name) const {
  return property(GL_UNIFORM, name, GL_ARRAY_STRIDE);
}

std::optional<int> Program::uniform_location(std::string_view name) const {
  return property(GL_UNIFORM, name, GL_LOCATION);
}

}  // namespace aspic::gl
