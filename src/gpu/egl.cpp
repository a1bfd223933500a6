#include "gpu/egl.h"

#include <dlfcn.h>

namespace aspic::gl {
namespace {

constexpr const char* file = "libEGL.so.1";

Error missing(const char* reason) {
  return advised(
      fail(ErrorCode::no_device, "OpenGL needs EGL, which cannot be loaded ({}).", reason ? reason : file),
      {advice("install it with a driver (apt install libegl1 libegl-mesa0 libgl1-mesa-dri)"),
       {RemedyKind::draw_nothing, {"cpu"}}});
}

Result<Egl> load() {
  // Never closed: drivers leave threads and thread-local data behind.
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!library) return missing(::dlerror());
  Egl egl = {};
  const char* absent = nullptr;
  const auto find = [&]<class F>(F*& function, const char* name) {
    // Preloaded libraries go first, as they do before a library that is linked.
    void* const preloaded = ::dlsym(RTLD_DEFAULT, name);
    function = reinterpret_cast<F*>(preloaded ? preloaded : ::dlsym(library, name));
    if (!function) absent = name;
  };
  find(egl.BindAPI, "eglBindAPI");
  find(egl.ChooseConfig, "eglChooseConfig");
  find(egl.CreateContext, "eglCreateContext");
  find(egl.DestroyContext, "eglDestroyContext");
  find(egl.GetCurrentContext, "eglGetCurrentContext");
  find(egl.GetCurrentDisplay, "eglGetCurrentDisplay");
  find(egl.GetCurrentSurface, "eglGetCurrentSurface");
  find(egl.GetDisplay, "eglGetDisplay");
  find(egl.GetError, "eglGetError");
  find(egl.GetPlatformDisplay, "eglGetPlatformDisplay");
  find(egl.GetProcAddress, "eglGetProcAddress");
  find(egl.Initialize, "eglInitialize");
  find(egl.MakeCurrent, "eglMakeCurrent");
  find(egl.QueryString, "eglQueryString");
  if (absent) return missing(fmt::format("{} has no {}, so it is older than EGL 1.5", file, absent).c_str());
  return egl;
}

}  // namespace

const Result<Egl>& load_egl() {
  static const Result<Egl> loaded = load();
  return loaded;
}

}  // namespace aspic::gl
