#include "gpu/context.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <new>
#include <string_view>

#include "base/printable.h"
#include "gpu/current.h"
#include "gpu/fence.h"
#include "gpu/program.h"
#include "gpu/read_ring.h"

namespace aspic::gl {
namespace {

/// A lost context may have an error for every call.
constexpr int most_errors = 64;

// Of KHR_robustness, core since OpenGL 4.5.
constexpr GLenum reset_notification_strategy = 0x8256;
constexpr GLint lose_context_on_reset = 0x8252;
constexpr GLenum context_lost = 0x0507;

// In KiB; of ATI's four numbers the first.
constexpr GLenum nvx_free_memory = 0x9049;
constexpr GLenum ati_vertex_free_memory = 0x87fb;

// Of KHR_parallel_shader_compile.
constexpr GLuint as_many_as_it_likes = 0xffffffffu;

bool has_extension(std::string_view name) {
  GLint count = 0;
  glGetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const GLubyte* found = glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
    if (found && name == reinterpret_cast<const char*>(found)) return true;
  }
  return false;
}

std::vector<Remedy> room_on_device() {
  return {advice("make the scene smaller"), advice("close other programs that use the device"),
          use_backend("cpu")};
}

}  // namespace

Context::Context() : programs_(std::make_unique<ProgramCache>(*this, program_folder())) {}

Result<std::shared_ptr<Context>> Context::adopt_current(Loader loader, WindowContext window) {
  const int version = gladLoadGL(loader);
  if (version == 0)
    return Error{ErrorCode::no_device,
                 "This thread has no current OpenGL context. Make the window's context current first."};
  if (version < GLAD_MAKE_VERSION(4, 3))
    return advised(
        fail(ErrorCode::no_device,
             "The window's context is OpenGL {}.{} ({}), but 4.3 core is needed for compute shaders.",
             GLAD_VERSION_MAJOR(version), GLAD_VERSION_MINOR(version),
             reinterpret_cast<const char*>(glGetString(GL_RENDERER))),
        {advice("install a newer driver"), {RemedyKind::draw_nothing, {"cpu"}}});
  std::shared_ptr<Context> context(new Context);
  context->window_ = std::move(window);
  context->thread_ = std::this_thread::get_id();
  context->note_egl();
  context->start("window", loader);
  return context;
}

void Context::start(std::string platform, Loader loader) {
  info_ = query_device_info();
  info_.platform = std::move(platform);

  GLint flags = 0;
  glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
  info_.debug = (flags & GL_CONTEXT_FLAG_DEBUG_BIT) != 0;
  if (has_extension("GL_KHR_robustness")) {
    reset_status_ = reinterpret_cast<GLenum (*)()>(loader("glGetGraphicsResetStatus"));
    GLint strategy = 0;
    glGetIntegerv(reset_notification_strategy, &strategy);
    info_.robust = reset_status_ && strategy == lose_context_on_reset;
  }
  // Some drivers compile on the calling thread until they are told how many threads they may take.
  for (const std::string name : {"KHR", "ARB"}) {
    if (!has_extension("GL_" + name + "_parallel_shader_compile")) continue;
    const auto set_most =
        reinterpret_cast<void (*)(GLuint)>(loader(("glMaxShaderCompilerThreads" + name).c_str()));
    if (set_most) set_most(as_many_as_it_likes);
    break;
  }
  // A software rasterizer's memory is the machine's, whatever its driver answers: Mesa 25's llvmpipe says
  // that 32 MiB are free where 20 GiB are.
  if (info_.is_software)
    memory_query_ = 0;
  else if (has_extension("GL_NVX_gpu_memory_info"))
    memory_query_ = nvx_free_memory;
  else if (has_extension("GL_ATI_meminfo"))
    memory_query_ = ati_vertex_free_memory;
  if (!info_.debug) return;

  // Synchronous, so that a message arrives within the call that caused it and on its thread.
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  const GLDEBUGPROC forward = [](GLenum, GLenum, GLuint id, GLenum severity, GLsizei length,
                                 const GLchar* text, const void* user) {
    const std::size_t size =
        length >= 0 ? static_cast<std::size_t>(length) : std::char_traits<char>::length(text);
    const Context& self = *static_cast<const Context*>(user);
    if (self.sink_) self.sink_({severity == GL_DEBUG_SEVERITY_HIGH, id, std::string(text, size)});
  };
  glDebugMessageCallback(forward, this);
}

bool Context::lost() {
  if (lost_) return true;
  const Current here(*this);
  if (!here.status()) return false;
  lost_ =
      dead_ || silent_ || strikes(Fault::lost_context) || (info_.robust && reset_status_() != GL_NO_ERROR);
  return lost_;
}

bool Context::ran_out_of_memory() {
  const Current here(*this);
  if (!here.status()) return false;
  bool found = strikes(Fault::out_of_memory);
  for (int n = 0; n < most_errors; ++n) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    if (error == GL_OUT_OF_MEMORY) {
      found = true;
    } else if (error != context_lost) {
      if (sink_) sink_({true, error, fmt::format("GL error 0x{:04x}", error)});
    }
  }
  return found;
}

std::optional<std::uint64_t> Context::free_memory() {
  if (assumed_free_ || memory_query_ == 0) return assumed_free_;
  const Current here(*this);
  if (!here.status()) return std::nullopt;
  std::array<GLint, 4> kibibytes = {};
  glGetIntegerv(memory_query_, kibibytes.data());
  // A number beyond 2 TiB has no place in it.
  if (kibibytes[0] <= 0) return std::nullopt;
  return std::uint64_t{1024} * static_cast<std::uint64_t>(kibibytes[0]);
}

Status Context::check_memory(std::uint64_t bytes) {
  const auto free = free_memory();
  if (!free || bytes <= *free) return {};
  return advised(fail(ErrorCode::scene_rejected,
                      "the scene needs {} ({} bytes) of memory on {}, and {} ({} bytes) are free.",
                      human_bytes(bytes), bytes, info_.renderer, human_bytes(*free), *free),
                 room_on_device());
}

void Context::forget_errors() {
  const Current here(*this);
  if (!here.status()) return;
  for (int n = 0; n < most_errors && glGetError() != GL_NO_ERROR; ++n) {
  }
}

Error Context::elsewhere_error() const {
  return fail(ErrorCode::no_device,
              "The OpenGL context on {} is in use on another thread. Call a gpu solver, and all rendering in "
              "its context, on one thread.",
              info_.renderer);
}

Error Context::lost_error() const {
  if (silent_)
    return advised(
        fail(ErrorCode::no_device, "The device {} has not answered for {} s.", info_.renderer, longest_wait),
        {advice("resume from the last checkpoint on another device"), use_backend("cpu")});
  return advised(
      fail(ErrorCode::no_device, "The device {} was reset or lost, with all its data.", info_.renderer),
      {advice("resume from the last checkpoint"), use_backend("cpu")});
}

Status Context::check(ErrorCode memory_code) {
  const Current here(*this);
  ASPIC_CHECK(here.status());
  if (lost()) return lost_error();
  if (!ran_out_of_memory()) return {};
  return advised(
      fail(memory_code,
           "The device {} ran out of memory during the computation, with {} ({} bytes) held in buffers.",
           info_.renderer, human_bytes(bytes_held_), bytes_held_),
      room_on_device());
}

void Context::inject_fault(Fault fault, std::uint64_t after) {
  faults_[static_cast<std::size_t>(fault)] = after;
}

void Context::take_back_faults() {
  // A lost device is at work on nothing; this one still is on what came before the loss, which nobody waited
  // for.
  if (dead_) glFinish();
  faults_ = {};
  dead_ = lost_ = silent_ = false;
}

bool Context::begins_dispatch() {
  ++dispatches_;
  if (strikes(Fault::lost_at_dispatch)) dead_ = true;
  return !dead_;
}

ReadRing& Context::reads() {
  if (!reads_) reads_ = std::make_unique<ReadRing>(*this, read_part_bytes);
  return *reads_;
}

void Context::release_objects() {
  programs_.reset();
  reads_.reset();
}

void Context::dispose(const Disposed& object) noexcept {
  if (const Current here(*this); here.status()) return remove(object);
  try {
    const std::lock_guard lock(disposed_mutex_);
    disposed_.push_back(object);
    any_disposed_ = true;
  } catch (const std::bad_alloc&) {
    // It goes with the context.
  }
}

void Context::remove(const Disposed& object) noexcept {
  if (object.sync) return glDeleteSync(static_cast<GLsync>(object.sync));
  if (object.deletion) return object.deletion(object.id);
  // Its number may soon be another buffer's.
  for (auto& points : bound_)
    for (Bound& bound : points)
      if (bound.id == object.id) bound = {};
  glDeleteBuffers(1, &object.id);
  bytes_held_ -= object.bytes;
}

void Context::remove_disposed() noexcept {
  if (!any_disposed_) return;
  const std::lock_guard lock(disposed_mutex_);
  for (const Disposed& object : disposed_) remove(object);
  disposed_.clear();
  any_disposed_ = false;
}

bool Context::strikes(Fault fault) {
  std::optional<std::uint64_t>& left = faults_[static_cast<std::size_t>(fault)];
  if (!left) return false;
  if (*left > 0) {
    --*left;
    return false;
  }
  left.reset();
  return true;
}

}  // namespace aspic::gl
