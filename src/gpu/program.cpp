#include "gpu/program.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <utility>
#include <vector>

namespace aspic::gl {
namespace {

template <class GetValue, class GetText>
std::string log_of(GLuint object, GetValue get_value, GetText get_text) {
  GLint length = 0;
  get_value(object, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  GLsizei written = 0;
  if (length > 0) get_text(object, length, &written, log.data());
  log.resize(static_cast<std::size_t>(written));
  return log;
}

/// Names of the active storage blocks.
std::vector<std::string> storage_blocks(GLuint program) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
  std::vector<std::string> names;
  for (GLint i = 0; i < count; ++i) {
    GLchar name[256];
    GLsizei length = 0;
    glGetProgramResourceName(program, GL_SHADER_STORAGE_BLOCK, static_cast<GLuint>(i), sizeof name, &length,
                             name);
    names.emplace_back(name, static_cast<std::size_t>(length));
  }
  return names;
}

/// One stage's source with its kind.
struct StageSource {
  GLenum kind;
  FlatShader source;
};

/// Compiles the stages and links them into a program, which debug messages call `label`.
Result<Name> build(Context& context, std::span<const StageSource> stages, std::string_view label) {
  const GLuint program = glCreateProgram();
  Name made(context, program, [](std::uint32_t id) { glDeleteProgram(id); });
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
      const std::string log = source.rewrite_log(log_of(shader, glGetShaderiv, glGetShaderInfoLog));
      detach_all();
      return fail(ErrorCode::no_device, "{} does not compile the shader {}:\n{}", context.info().renderer,
                  source.path(), log);
    }
    names += fmt::format("{}{}", names.empty() ? "" : " with ", source.path());
  }
  glLinkProgram(program);
  detach_all();
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) {
    if (context.info().debug)
      glObjectLabel(GL_PROGRAM, program, static_cast<GLsizei>(label.size()), label.data());
    return made;
  }
  // With several stages a line number does not say whose it is, so only a lone stage's log is translated.
  const std::string log = log_of(program, glGetProgramiv, glGetProgramInfoLog);
  return fail(ErrorCode::no_device, "{} does not link the shader {}:\n{}", context.info().renderer, names,
              stages.size() == 1 ? stages[0].source.rewrite_log(log) : log);
}

}  // namespace

Result<Program> Program::compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines) {
  ASPIC_TRY(const auto source, library.flatten(path, defines));
  return compute(context, source);
}

Result<Program> Program::compute(Context& context, const FlatShader& source) {
  Program program;
  program.path_ = source.path();
  program.context_ = &context;
  const StageSource stage = {GL_COMPUTE_SHADER, source};
  ASPIC_TRY(program.name_, build(context, std::span(&stage, 1), source.path()));
  const std::vector<std::string> blocks = storage_blocks(program.id());
  if (blocks.size() > max_storage_blocks)
    return fail(ErrorCode::no_device,
                "The shader {} uses {} storage blocks ({}), but OpenGL 4.3 guarantees {}. Put some of "
                "them into one block.",
                source.path(), blocks.size(), fmt::join(blocks, ", "), max_storage_blocks);
  GLint size[3] = {};
  glGetProgramiv(program.id(), GL_COMPUTE_WORK_GROUP_SIZE, size);
  for (std::size_t i = 0; i < 3; ++i) program.group_size_[i] = static_cast<std::uint32_t>(size[i]);
  return program;
}

Result<Program> Program::graphics(Context& context, const ShaderLibrary& library,
                                  const GraphicsStages& stages, std::span<const Define> defines) {
  std::vector<StageSource> sources;
  for (const auto& [kind, path] :
       {std::pair{GL_VERTEX_SHADER, stages.vertex}, std::pair{GL_FRAGMENT_SHADER, stages.fragment},
        std::pair{GL_GEOMETRY_SHADER, stages.geometry}}) {
    if (path.empty()) continue;
    ASPIC_TRY(auto source, library.flatten(path, defines));
    sources.push_back({static_cast<GLenum>(kind), std::move(source)});
  }
  Program program;
  program.path_ = stages.fragment;
  program.context_ = &context;
  ASPIC_TRY(program.name_, build(context, sources, stages.fragment));
  if (const auto blocks = storage_blocks(program.id()); !blocks.empty())
    return fail(ErrorCode::no_device,
                "The shader {} with {} uses storage blocks ({}), but OpenGL 4.3 guarantees none "
                "while drawing. Pass the data as vertex attributes or a uniform block.",
                stages.vertex, stages.fragment, fmt::join(blocks, ", "));
  return program;
}

void Program::set(int location, std::uint32_t value) const {
  glProgramUniform1ui(id(), location, value);
}

void Program::set(int location, std::int32_t value) const {
  glProgramUniform1i(id(), location, value);
}

void Program::set(int location, float value) const {
  glProgramUniform1f(id(), location, value);
}

void Program::set(int location, const std::array<float, 4>& value) const {
  glProgramUniform4f(id(), location, value[0], value[1], value[2], value[3]);
}

void Program::set(int location, const std::array<std::uint32_t, 4>& value) const {
  glProgramUniform4ui(id(), location, value[0], value[1], value[2], value[3]);
}

Result<std::shared_ptr<const Program>> ProgramCache::compute(const ShaderLibrary& library,
                                                             std::string_view path,
                                                             std::span<const Define> defines) {
  ASPIC_TRY(auto source, library.flatten(path, defines));
  std::string name(path);
  for (const Define& d : defines) name += '\n' + d.name + ' ' + d.value;
  const auto found = entries_.find(name);
  if (found != entries_.end() && found->second.text == source.text()) return found->second.program;

  std::string text = source.text();
  ASPIC_TRY(auto made, Program::compute(context_, source));
  ++compiled_;
  auto program = std::make_shared<const Program>(std::move(made));
  entries_.insert_or_assign(std::move(name), Entry{std::move(text), program});
  return program;
}

}  // namespace aspic::gl
