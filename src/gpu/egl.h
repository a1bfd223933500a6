#pragma once
// EGL, loaded when it is first needed: what computes on the processor alone runs on a machine without it.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "base/result.h"

namespace aspic::gl {

/// The functions of libEGL.so.1 that are called here.
struct Egl {
  decltype(&::eglBindAPI) BindAPI;
  decltype(&::eglChooseConfig) ChooseConfig;
  decltype(&::eglCreateContext) CreateContext;
  decltype(&::eglDestroyContext) DestroyContext;
  decltype(&::eglGetCurrentContext) GetCurrentContext;
  decltype(&::eglGetCurrentDisplay) GetCurrentDisplay;
  decltype(&::eglGetCurrentSurface) GetCurrentSurface;
  decltype(&::eglGetDisplay) GetDisplay;
  decltype(&::eglGetError) GetError;
  decltype(&::eglGetPlatformDisplay) GetPlatformDisplay;
  decltype(&::eglGetProcAddress) GetProcAddress;
  decltype(&::eglInitialize) Initialize;
  decltype(&::eglMakeCurrent) MakeCurrent;
  decltype(&::eglQueryString) QueryString;
};

/// EGL, the same for the life of the program. Error (no_device): it cannot be loaded; the sentence says what
/// to install.
const Result<Egl>& load_egl();

/// The same where a context of EGL exists, so that it is loaded.
inline const Egl& egl() {
  return *load_egl();
}

}  // namespace aspic::gl
