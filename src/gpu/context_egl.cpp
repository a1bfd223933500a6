// Contexts without a display, through EGL.
#include <fmt/format.h>
#include <glad/gl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>

#include "base/flush_denormals.h"
#include "base/memory.h"
#include "base/printable.h"
#include "gpu/context.h"
#include "gpu/current.h"
#include "gpu/device_info.h"
#include "gpu/egl.h"
#include "gpu/program.h"
#include "gpu/read_ring.h"

namespace aspic::gl {

/// One way to a display.
struct EglCandidate {
  std::string name;
  EGLenum platform = 0;  // 0: eglGetDisplay
  void* native = nullptr;
  DeviceChoice demand = DeviceChoice::automatic;  // not index
};

namespace {

bool has_extension(const char* list, std::string_view name) {
  if (!list) return false;
  const std::string padded = fmt::format(" {} ", list);
  return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

bool client_has(std::string_view name) {
  return has_extension(egl().QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name);
}

template <class F>
F function(const char* name) {
  return reinterpret_cast<F>(egl().GetProcAddress(name));
}

std::string egl_error() {
  const EGLint code = egl().GetError();
  constexpr std::pair<EGLint, const char*> names[] = {{EGL_SUCCESS, "no EGL error"},
                                                      {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
                                                      {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
                                                      {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
                                                      {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
                                                      {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
                                                      {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
                                                      {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"}};
  for (const auto& [known, name] : names)
    if (code == known) return name;
  return fmt::format("EGL error 0x{:04x}", code);
}

std::vector<EGLDeviceEXT> egl_devices() {
  if (!load_egl()) return {};
  if (!client_has("EGL_EXT_device_enumeration") && !client_has("EGL_EXT_device_base")) return {};
  const auto query = function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (!query || !query(0, nullptr, &count) || count <= 0) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!query(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

EglDevice describe_device(int index, EGLDeviceEXT device) {
  EglDevice result;
  result.index = index;
  const auto query = function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const char* extensions = query ? query(device, EGL_EXTENSIONS) : nullptr;
  result.software = has_extension(extensions, "EGL_MESA_device_software");
  const auto append = [&](const char* extension, EGLint what) {
    const char* text = has_extension(extensions, extension) ? query(device, what) : nullptr;
    if (text) result.name += fmt::format("{}{}", result.name.empty() ? "" : ", ", text);
  };
  append("EGL_EXT_device_query_name", EGL_VENDOR);
  append("EGL_EXT_device_query_name", EGL_RENDERER_EXT);
  append("EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT);
  append("EGL_EXT_device_drm_render_node", EGL_DRM_RENDER_NODE_FILE_EXT);
  if (result.name.empty()) result.name = result.software ? "software rasterizer" : "unnamed";
  return result;
}

/// The choice after the environment had its say.
struct Choice {
  DeviceChoice device = DeviceChoice::automatic;
  int index = 0;
  std::string_view platform;  // "surfaceless" or "default": that alone
  std::string_view wish;      // ASPIC_EGL_DEVICE; empty: not set
};

Result<Choice> choose(const ContextOptions& options) {
  const char* variable = std::getenv("ASPIC_EGL_DEVICE");
  const std::string_view wish = variable ? variable : "";
  Choice choice{options.device, options.device_index, {}, wish};
  if (wish.empty()) return choice;
  const auto index = std::from_chars(wish.data(), wish.data() + wish.size(), choice.index);
  if (index.ec == std::errc() && index.ptr == wish.data() + wish.size() && choice.index >= 0)
    choice.device = DeviceChoice::index;
  else if (wish == "automatic")
    choice.device = DeviceChoice::automatic;
  else if (wish == "hardware")
    choice.device = DeviceChoice::hardware;
  else if (wish == "software")
    choice.device = DeviceChoice::software;
  else if (wish == "surfaceless" || wish == "default")
    choice.platform = wish;
  else
    return fail(ErrorCode::no_device,
                "The environment variable ASPIC_EGL_DEVICE is \"{}\", which names no device. Allowed: "
                "automatic, hardware, software, surfaceless, default, or an index from aspic info.",
                printable_line(wish));
  return choice;
}

Result<std::vector<EglCandidate>> candidates(const Choice& choice) {
  const std::vector<EGLDeviceEXT> devices = egl_devices();
  std::vector<EglCandidate> result;
  const auto add_device = [&](std::size_t i, DeviceChoice demand) {
    result.push_back({fmt::format("EGL device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[i], demand});
  };
  if (choice.device == DeviceChoice::index && choice.platform.empty()) {
    const auto i = static_cast<std::size_t>(choice.index);
    if (choice.index < 0 || i >= devices.size())
      return fail(ErrorCode::no_device,
                  "EGL device {} does not exist: EGL lists {} device{}. Choose an index from aspic info.",
                  choice.index, devices.size(), devices.size() == 1 ? "" : "s");
    add_device(i, DeviceChoice::automatic);
    return result;
  }
  const DeviceChoice general = choice.device == DeviceChoice::index ? DeviceChoice::automatic : choice.device;
  if (choice.platform.empty() && client_has("EGL_EXT_platform_device")) {
    // A hardware node that may not be opened can quietly become a rasterizer: then a later device may still
    // be real.
    for (std::size_t i = 0; i < devices.size() && general != DeviceChoice::software; ++i)
      if (!describe_device(static_cast<int>(i), devices[i]).software) add_device(i, DeviceChoice::hardware);
    for (std::size_t i = 0; i < devices.size() && general != DeviceChoice::hardware; ++i)
      if (describe_device(static_cast<int>(i), devices[i]).software) add_device(i, general);
  }
  if (choice.platform != "default" && client_has("EGL_MESA_platform_surfaceless"))
    result.push_back({"EGL surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA, nullptr, general});
  if (choice.platform != "surfaceless") result.push_back({"EGL default display", 0, nullptr, general});
  return result;
}

constexpr std::uint64_t mebi = std::uint64_t{1} << 20;

/// What drivers need so much that they die of a signal where it is missing: address space for themselves, a
/// shader compiler and their threads, and stack to compile on. Empty: it is there, as far as limits of the
/// process go.
std::string missing_resource() {
  const auto threads = static_cast<std::uint64_t>(std::clamp(::sysconf(_SC_NPROCESSORS_ONLN), 1L, 32L));
  const std::uint64_t space = (704 + 16 * threads) * mebi;
  if (const auto left = address_space_left(); left && *left < space) {
    return fmt::format(
        "OpenGL needs about {} of address space for its driver, and the limit of this process (ulimit -v) "
        "leaves {}",
        human_bytes(space), human_bytes(*left));
  }
  rlimit stack = {};
  if (::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur < mebi) {
    return fmt::format(
        "OpenGL drivers need 1 MiB of stack to compile shaders, and the limit of this process (ulimit -s) "
        "is {} KiB",
        stack.rlim_cur >> 10);
  }
  return "";
}

/// Mesa's software rasterizers divide by zero with another width than these.
bool vector_width_crashes() {
  const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
  const std::string_view text = width ? width : "";
  return !text.empty() && text != "128" && text != "256" && text != "512";
}

EGLContext create_context(EGLDisplay display, const ContextOptions& options) {
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_extension(egl().QueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!egl().ChooseConfig(display, wanted, &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  }
  // Robustness is a wish: drivers that know nothing of it refuse the attribute.
  for (const bool robust : {true, false}) {
    if (robust && !options.robust) continue;
    std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                      EGL_CONTEXT_MINOR_VERSION,       3,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    if (options.debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
    if (robust)
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                         EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    attributes.push_back(EGL_NONE);
    const EGLContext context = egl().CreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

/// Nothing where EGL is not loaded and cannot be: windows of other systems need none.
Context::Place current_place() {
  if (!load_egl()) return {};
  return {egl().GetCurrentDisplay(), egl().GetCurrentContext(), egl().GetCurrentSurface(EGL_DRAW),
          egl().GetCurrentSurface(EGL_READ)};
}

/// Takes the current context off a thread that ends. EGL does not, so it would be in use there for good.
struct ThreadEnd {
  bool entered = false;
  ~ThreadEnd() {
    // The first thread ends with the program, when drivers may be gone already.
    if (entered && ::gettid() != ::getpid() && egl().GetCurrentContext() != EGL_NO_CONTEXT)
      egl().MakeCurrent(egl().GetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
};
thread_local ThreadEnd thread_end;

/// Forks before the first display was opened; −1: none is.
std::atomic<std::int64_t> opened_at = -1;

Error forked_error() {
  return fail(ErrorCode::no_device,
              "OpenGL was in use before this process was forked, and its driver cannot be used in a child "
              "process. Start child processes by 'spawn', or use OpenGL in them alone.");
}

/// What is said of a device of the kind that was not asked for.
constexpr std::string_view found_software = "a software rasterizer",
                           found_hardware = "no software rasterizer";

/// What helps where no device fits: a variable that refuses what is there, and drivers that are missing.
std::vector<Remedy> remedies(const Choice& choice, std::string_view tried) {
  std::vector<Remedy> all;
  if (!choice.wish.empty())
    all.push_back(advice(fmt::format("unset the environment variable ASPIC_EGL_DEVICE, which is \"{}\"",
                                     printable_line(choice.wish))));
  const auto found = [&](std::string_view kind) { return tried.find(kind) != std::string_view::npos; };
  const char* const always = std::getenv("LIBGL_ALWAYS_SOFTWARE");
  if (choice.device == DeviceChoice::hardware && always && found(found_software))
    all.push_back(advice("unset the environment variable LIBGL_ALWAYS_SOFTWARE"));
  if (!found(found_hardware))
    all.push_back(advice("install the graphics card's OpenGL driver with its EGL part"));
  if (!found(found_software))
    all.push_back(
        advice("install Mesa's software rasterizer (apt install libegl1 libegl-mesa0 libgl1-mesa-dri)"));
  all.push_back({RemedyKind::draw_nothing, {"cpu"}});
  return all;
}

/// An error in the words that follow a candidate's name.
template <class... T>
Error unfit(fmt::format_string<T...> why, T&&... arguments) {
  return fail(ErrorCode::no_device, why, std::forward<T>(arguments)...);
}

}  // namespace

std::vector<EglDevice> list_devices() {
  std::vector<EglDevice> result;
  for (const EGLDeviceEXT device : egl_devices())
    result.push_back(describe_device(static_cast<int>(result.size()), device));
  return result;
}

Result<std::shared_ptr<Context>> Context::create_on(const EglCandidate& candidate,
                                                    const ContextOptions& options) {
  if (candidate.demand != DeviceChoice::hardware && vector_width_crashes())
    return unfit(
        "may be a software rasterizer, which crashes with this value of the environment variable "
        "LP_NATIVE_VECTOR_WIDTH (allowed are 128, 256 and 512)");
  const EGLDisplay display = candidate.platform
                                 ? egl().GetPlatformDisplay(candidate.platform, candidate.native, nullptr)
                                 : egl().GetDisplay(EGL_DEFAULT_DISPLAY);
  // A display is never terminated: EGL returns the same one to every caller in the process.
  if (display == EGL_NO_DISPLAY || !egl().Initialize(display, nullptr, nullptr))
    return unfit("cannot be opened ({})", egl_error());
  if (!has_extension(egl().QueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
    return unfit("cannot work without a window surface");
  if (!egl().BindAPI(EGL_OPENGL_API)) return unfit("has no desktop OpenGL ({})", egl_error());
  const EGLContext egl_context = create_context(display, options);
  if (egl_context == EGL_NO_CONTEXT) return unfit("provides no OpenGL 4.3 core context ({})", egl_error());
  std::shared_ptr<Context> context(new Context);
  context->egl_ = {display, egl_context};
  context->owned_ = true;
  if (!egl().MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl_context))
    return unfit("cannot make its context current ({})", egl_error());
  thread_end.entered = true;
  if (gladLoadGL(egl().GetProcAddress) < GLAD_MAKE_VERSION(4, 3))
    return unfit("lacks functions of OpenGL 4.3");
  const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool software = is_software_renderer(renderer);
  if ((candidate.demand == DeviceChoice::hardware && software) ||
      (candidate.demand == DeviceChoice::software && !software))
    return unfit("is {}, {}", renderer, software ? found_software : found_hardware);
  context->start(candidate.name, egl().GetProcAddress);
  return context;
}

Result<std::shared_ptr<Context>> Context::create_headless(const ContextOptions& options) {
  const FlushDenormals flush;  // the driver's threads inherit it
  const auto now = static_cast<std::int64_t>(forks());
  if (const std::int64_t opened = opened_at.exchange(now); opened >= 0 && opened != now) {
    opened_at = opened;
    return forked_error();
  }
  if (const std::string missing = missing_resource(); !missing.empty()) {
    return advised({ErrorCode::no_device, missing + "."},
                   {advice("raise it"), {RemedyKind::draw_nothing, {"cpu"}}});
  }
  if (const auto& loaded = load_egl(); !loaded) return loaded.error();
  ASPIC_TRY(const Choice choice, choose(options));
  ASPIC_TRY(const std::vector<EglCandidate> ways, candidates(choice));
  const Place before = current_place();
  std::string tried;
  for (const EglCandidate& candidate : ways) {
    auto context = create_on(candidate, options);
    if (context) return context;
    if (before.context) put_back(before);
    tried += fmt::format("{}{} {}", tried.empty() ? "" : "; ", candidate.name, context.error().what);
  }
  return advised(
      fail(ErrorCode::no_device, "Aspic found no usable OpenGL 4.3 core device without a display. Tried: {}.",
           tried.empty() ? "nothing, EGL offers no platform" : tried),
      remedies(choice, tried));
}

/// Of an adopted context; an owned one has no surfaces.
void Context::note_egl() {
  egl_ = current_place();
}

bool Context::is_current() const {
  if (egl_.context) return egl().GetCurrentContext() == egl_.context;
  return std::this_thread::get_id() == thread_ && (!window_.is_current || window_.is_current());
}

Status Context::enter(Place& before) {
  if (forks_ != forks()) return forked_error();
  if (!is_current()) {
    if (!owned_ && std::this_thread::get_id() != thread_) return elsewhere_error();
    if (egl_.context) {
      const Place current = current_place();
      if (!egl().MakeCurrent(egl_.display, egl_.draw, egl_.read, egl_.context)) {
        const std::string error = egl_error();
        if (error != "EGL_BAD_ACCESS")
          return fail(ErrorCode::no_device, "Cannot make the OpenGL context on {} current ({}).",
                      info_.renderer, error);
        return elsewhere_error();
      }
      before = current;
      thread_end.entered = true;
    } else {
      if (window_.make_current) window_.make_current();
      if (!is_current())
        return fail(ErrorCode::no_device, "Cannot make the window's OpenGL context on {} current.",
                    info_.renderer);
    }
  }
  remove_disposed();
  return {};
}

Status Context::make_current() {
  Place before;
  return enter(before);
}

void Context::put_back(const Place& before) {
  egl().MakeCurrent(before.display, before.draw, before.read, before.context);
}

Context::~Context() {
  if (forks_ != forks()) return;  // the parent's
  {
    const Current here(*this);
    release_objects();
    if (!owned_ && info_.debug && here.status()) glDebugMessageCallback(nullptr, nullptr);
  }
  if (!owned_) return;
  if (egl().GetCurrentContext() == egl_.context)
    egl().MakeCurrent(egl_.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  egl().DestroyContext(egl_.display, egl_.context);
}

}  // namespace aspic::gl
