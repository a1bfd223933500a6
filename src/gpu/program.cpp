#include "gpu/program.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <utility>
#include <vector>

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

/// One stage's source with its kind.
struct StageSource {
  GLenum kind;
  FlatShader source;
};

/// Compiles the stages and links them into `program`.
Status build(GLuint program, Context& context, std::span<const StageSource> stages) {
  std::vector<GLuint> shaders;
  const auto detach_all = [&] {
    for (const GLuint shader : shaders) {
      glDetachShader(program, shader);
      glDeleteShader(shader);
    }
  };
  std::string names;
  for (const StageSource& stage : stages) {
    const FlatShader& source = stage.source;
    const GLuint shader = glCreateShader(stage.kind);
    const GLchar* text = source.text().data();
    const auto length = static_cast<GLint>(source.text().size());
    glShaderSource(shader, 1, &text, &length);
    glCompileShader(shader);
    glAttachShader(program, shader);
    shaders.push_back(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
      const std::string log = source.rewrite_log(shader_log(shader));
      detach_all();
      return Error{ErrorCode::no_device, fmt::format("{} does not compile the shader {}:\n{}",
                                                     context.info().renderer, source.path(), log)};
    }
    names += fmt::format("{}{}", names.empty() ? "" : " with ", source.path());
  }
  glLinkProgram(program);
  detach_all();
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return {};
  // With several stages a line number does not say whose it is, so only a lone stage's log is translated.
  const std::string log = program_log(program);
  return Error{ErrorCode::no_device,
               fmt::format("{} does not link the shader {}:\n{}", context.info().renderer, names,
                           stages.size() == 1 ? stages[0].source.rewrite_log(log) : log)};
}

void label(const Context& context, GLuint program, std::string_view path) {
  if (context.info().debug)
    glObjectLabel(GL_PROGRAM, program, static_cast<GLsizei>(path.size()), path.data());
}

}  // namespace

Result<Program> Program::compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines) {
  const auto source = library.flatten(path, defines);
  if (!source) return source.error();
  return compute(context, *source);
}

Result<Program> Program::compute(Context& context, const FlatShader& source) {
  const std::string& path = source.path();
  Program program;
  program.path_ = path;
  program.context_ = &context;
  program.id_ = glCreateProgram();
  const StageSource stage = {GL_COMPUTE_SHADER, source};
  const Status built = build(program.id_, context, std::span(&stage, 1));
  if (!built) return built.error();

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
  label(context, program.id_, path);
  return program;
}

Result<Program> Program::graphics(Context& context, const ShaderLibrary& library,
                                  const GraphicsStages& stages, std::span<const Define> defines) {
  std::vector<StageSource> sources;
  for (const auto& [kind, path] :
       {std::pair{GL_VERTEX_SHADER, stages.vertex}, std::pair{GL_FRAGMENT_SHADER, stages.fragment},
        std::pair{GL_GEOMETRY_SHADER, stages.geometry}}) {
    if (path.empty()) continue;
    auto source = library.flatten(path, defines);
    if (!source) return source.error();
    sources.push_back({static_cast<GLenum>(kind), std::move(*source)});
  }
  Program program;
  program.path_ = stages.fragment;
  program.context_ = &context;
  program.id_ = glCreateProgram();
  const Status built = build(program.id_, context, sources);
  if (!built) return built.error();
  glGetProgramInterfaceiv(program.id_, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES,
                          &program.storage_blocks_);
  if (program.storage_blocks_ > 0)
    return Error{
        ErrorCode::no_device,
        fmt::format("The shader {} with {} uses storage blocks ({}), but OpenGL 4.3 guarantees none "
                    "while drawing. Pass the data as vertex attributes or a uniform block.",
                    stages.vertex, stages.fragment, block_names(program.id_, program.storage_blocks_))};
  label(context, program.id_, stages.fragment);
  return program;
}

Program::~Program() {
  release();
}

Program::Program(Program&& other) noexcept
    : context_(std::exchange(other.context_, nullptr)),
      id_(std::exchange(other.id_, 0)),
      path_(std::move(other.path_)),
      group_size_(other.group_size_),
      storage_blocks_(other.storage_blocks_) {}

Program& Program::operator=(Program&& other) noexcept {
  if (this == &other) return *this;
  release();
  context_ = std::exchange(other.context_, nullptr);
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

void Program::set(int location, const std::array<float, 4>& value) const {
  glProgramUniform4f(id_, location, value[0], value[1], value[2], value[3]);
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
