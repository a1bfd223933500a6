#include "gpu/program.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/fnv.h"

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

}  // namespace

Result<std::vector<Program::Stage>> Program::flatten(const ShaderLibrary& library,
                                                     const ProgramStages& stages,
                                                     std::span<const Define> defines) {
  std::vector<Stage> flat;
  for (const auto& [kind, path] :
       {std::pair{GL_VERTEX_SHADER, stages.vertex}, std::pair{GL_FRAGMENT_SHADER, stages.fragment},
        std::pair{GL_GEOMETRY_SHADER, stages.geometry}, std::pair{GL_COMPUTE_SHADER, stages.compute}}) {
    if (path.empty()) continue;
    ASPIC_TRY(auto source, library.flatten(path, defines));
    flat.push_back({static_cast<GLenum>(kind), std::move(source)});
  }
  return flat;
}

Program Program::start(Context& context, std::vector<Stage> stages,
                       const std::optional<ProgramBinary>& binary, bool keeps_binary) {
  const GLuint id = glCreateProgram();
  Program program;
  program.context_ = &context;
  program.name_ = Name(context, id, [](std::uint32_t name) { glDeleteProgram(name); });
  program.path_ = std::ranges::find_if(stages, [](const Stage& stage) {
                    return stage.kind == GL_COMPUTE_SHADER || stage.kind == GL_FRAGMENT_SHADER;
                  })->source.path();
  GLint linked = 0;
  if (binary) {
    glProgramBinary(id, binary->format, binary->bytes.data(), static_cast<GLsizei>(binary->bytes.size()));
    glGetProgramiv(id, GL_LINK_STATUS, &linked);
  }
  if (!linked) {
    for (Stage& stage : stages) {
      const FlatShader& source = stage.source;
      stage.shader = glCreateShader(stage.kind);
      const GLchar* text = source.text().data();
      const auto length = static_cast<GLint>(source.text().size());
      glShaderSource(stage.shader, 1, &text, &length);
      glCompileShader(stage.shader);
      glAttachShader(id, stage.shader);
      glDeleteShader(stage.shader);  // as soon as it is detached, or the program goes
    }
    if (keeps_binary) glProgramParameteri(id, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    glLinkProgram(id);
  }
  program.stages_ = std::move(stages);
  return program;
}

Status Program::check_compiled() const {
  std::string names;
  for (const Stage& stage : stages_) {
    GLint ok = 0;
    glGetShaderiv(stage.shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
      const std::string log =
          stage.source.rewrite_log(log_of(stage.shader, glGetShaderiv, glGetShaderInfoLog));
      return fail(ErrorCode::no_device, "{} does not compile the shader {}:\n{}", context_->info().renderer,
                  stage.source.path(), log);
    }
    names += fmt::format("{}{}", names.empty() ? "" : " with ", stage.source.path());
  }
  GLint ok = 0;
  glGetProgramiv(id(), GL_LINK_STATUS, &ok);
  if (ok) return {};
  // With several stages a line number does not say whose it is, so only a lone stage's log is translated.
  const std::string log = log_of(id(), glGetProgramiv, glGetProgramInfoLog);
  return fail(ErrorCode::no_device, "{} does not link the shader {}:\n{}", context_->info().renderer, names,
              stages_.size() == 1 ? stages_[0].source.rewrite_log(log) : log);
}

Status Program::check_blocks() {
  const std::vector<std::string> blocks = storage_blocks(id());
  if (stages_.front().kind != GL_COMPUTE_SHADER) {
    if (blocks.empty()) return {};
    return fail(ErrorCode::no_device,
                "The shader {} with {} uses storage blocks ({}), but OpenGL 4.3 guarantees none "
                "while drawing. Pass the data as vertex attributes or a uniform block.",
                stages_.front().source.path(), path_, fmt::join(blocks, ", "));
  }
  if (blocks.size() > max_storage_blocks)
    return fail(ErrorCode::no_device,
                "The shader {} uses {} storage blocks ({}), but OpenGL 4.3 guarantees {}. Put some of "
                "them into one block.",
                path_, blocks.size(), fmt::join(blocks, ", "), max_storage_blocks);
  GLint size[3] = {};
  glGetProgramiv(id(), GL_COMPUTE_WORK_GROUP_SIZE, size);
  for (std::size_t i = 0; i < 3; ++i) group_size_[i] = static_cast<std::uint32_t>(size[i]);
  return {};
}

Status Program::finish() {
  if (compiles()) {
    ASPIC_CHECK(check_compiled());
    for (const Stage& stage : stages_) glDetachShader(id(), stage.shader);
  }
  ASPIC_CHECK(check_blocks());
  if (context_->info().debug)
    glObjectLabel(GL_PROGRAM, id(), static_cast<GLsizei>(path_.size()), path_.data());
  stages_.clear();
  return {};
}

ProgramBinary Program::binary() const {
  GLint length = 0;
  glGetProgramiv(id(), GL_PROGRAM_BINARY_LENGTH, &length);
  ProgramBinary binary = {0, std::string(static_cast<std::size_t>(length), '\0')};
  if (length > 0) glGetProgramBinary(id(), length, &length, &binary.format, binary.bytes.data());
  binary.bytes.resize(static_cast<std::size_t>(length));
  return binary;
}

Result<Program> Program::compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines) {
  return graphics(context, library, {.compute = path}, defines);
}

Result<Program> Program::graphics(Context& context, const ShaderLibrary& library, const ProgramStages& stages,
                                  std::span<const Define> defines) {
  ASPIC_TRY(auto flat, flatten(library, stages, defines));
  Program program = start(context, std::move(flat));
  ASPIC_CHECK(program.finish());
  return program;
}

void Program::set(int location, std::uint32_t value) const {
  if (id() == 0) return;
  glProgramUniform1ui(id(), location, value);
}

void Program::set(int location, std::int32_t value) const {
  if (id() == 0) return;
  glProgramUniform1i(id(), location, value);
}

void Program::set(int location, float value) const {
  if (id() == 0) return;
  glProgramUniform1f(id(), location, value);
}

void Program::set(int location, const std::array<float, 4>& value) const {
  if (id() == 0) return;
  glProgramUniform4f(id(), location, value[0], value[1], value[2], value[3]);
}

void Program::set(int location, const std::array<std::uint32_t, 4>& value) const {
  if (id() == 0) return;
  glProgramUniform4ui(id(), location, value[0], value[1], value[2], value[3]);
}

/// Of 128 bits: what is equal by it is one program.
std::string ProgramCache::key_of(const std::vector<Program::Stage>& stages) {
  if (!device_) {
    const DeviceInfo& info = context_.info();
    device_ = fmt::format("{}\n{}\n{}\n{}\n{}{}\n", info.vendor, info.renderer, info.version,
                          info.glsl_version, info.debug, info.robust);
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    keeps_binaries_ = formats > 0 && !files_.folder().empty();
  }
  Fnv1a128 hash;
  hash.add_bytes(std::as_bytes(std::span(*device_)));
  for (const Program::Stage& stage : stages) {
    hash.add_bytes(std::as_bytes(std::span(&stage.kind, 1)));
    hash.add_bytes(std::as_bytes(std::span(stage.source.text())));
  }
  return hash.digits();
}

Result<SharedProgram> ProgramCache::start(const ShaderLibrary& library, const ProgramStages& stages,
                                          std::span<const Define> defines) {
  ASPIC_TRY(auto flat, Program::flatten(library, stages, defines));
  const std::string key = key_of(flat);
  for (const auto& [name, program] : entries_)
    if (program->key_ == key) return SharedProgram(program);
  for (const Pending& pending : pending_)
    if (pending.program->key_ == key) return SharedProgram(pending.program);

  std::string name;
  for (const Program::Stage& stage : flat) name += stage.source.path() + '\n';
  for (const Define& d : defines) name += d.name + ' ' + d.value + '\n';
  std::optional<ProgramBinary> binary;
  if (keeps_binaries_) binary = files_.load(key);
  auto program =
      std::make_shared<Program>(Program::start(context_, std::move(flat), binary, keeps_binaries_));
  program->key_ = key;
  pending_.push_back({std::move(name), program});
  return SharedProgram(program);
}

Status ProgramCache::finish(const SharedProgram& program) {
  if (program->finished()) return {};
  const auto found = std::ranges::find(pending_, program, &Pending::program);
  if (found == pending_.end())
    return fail(ErrorCode::no_device, "The driver rejected the shader {} before.", program->path());
  const Pending pending = std::move(*found);
  pending_.erase(found);
  const bool compiles = program->compiles();
  ASPIC_CHECK(pending.program->finish());
  ++(compiles ? compiled_ : loaded_);
  if (compiles && keeps_binaries_) files_.store(program->key_, program->binary());
  entries_.insert_or_assign(pending.name, pending.program);
  return {};
}

Result<SharedProgram> ProgramCache::compute(const ShaderLibrary& library, std::string_view path,
                                            std::span<const Define> defines) {
  return graphics(library, {.compute = path}, defines);
}

Result<SharedProgram> ProgramCache::graphics(const ShaderLibrary& library, const ProgramStages& stages,
                                             std::span<const Define> defines) {
  ASPIC_TRY(auto program, start(library, stages, defines));
  ASPIC_CHECK(finish(program));
  return program;
}

Result<SharedProgram> ProgramBatch::start(const ShaderLibrary& library, const ProgramStages& stages,
                                          std::span<const Define> defines) {
  ASPIC_TRY(auto program, cache_.start(library, stages, defines));
  started_.push_back(program);
  return program;
}

Status ProgramBatch::finish() {
  for (const auto& program : started_) ASPIC_CHECK(cache_.finish(program));
  return {};
}

}  // namespace aspic::gl
