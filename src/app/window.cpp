#include "app/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/flush_denormals.h"

namespace aspic::app {
namespace {

constexpr const char* instead =
    "To simulate without a window, run aspic run SCENE. aspic run SCENE --video FILE.mp4 makes a video.";

std::string last_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

EventReceiver* receiver_of(GLFWwindow* window) {
  return *static_cast<EventReceiver**>(glfwGetWindowUserPointer(window));
}

/// Why there is no display, and what to do.
std::string no_display() {
  const std::string_view built = glfwGetVersionString();
  const bool x = std::getenv("DISPLAY"), wayland = std::getenv("WAYLAND_DISPLAY"),
             for_x = built.find("X11") != built.npos, for_wayland = built.find("Wayland") != built.npos;
  if (!x && !wayland) return "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set";
  if (!x && !for_wayland)
    return "GLFW supports X11 only, and DISPLAY is not set. Install xwayland or libglfw3-wayland";
  if (!wayland && !for_x)
    return "GLFW supports Wayland only, and WAYLAND_DISPLAY is not set. Install libglfw3";
  return "the display does not answer";
}

/// Where the window is on the screen; nothing under Wayland, which keeps that to itself.
std::optional<std::array<int, 2>> position_of(GLFWwindow* window) {
  std::array<int, 2> position = {};
  glfwGetError(nullptr);
  glfwGetWindowPos(window, &position[0], &position[1]);
  if (glfwGetError(nullptr) != GLFW_NO_ERROR) return std::nullopt;
  return position;
}

/// Time between two frames of the first monitor [s].
double refresh_interval() {
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  return 1.0 / (mode && mode->refreshRate > 0 ? mode->refreshRate : 60);
}

bool display_lost = false;

/// Xlib ends a program as soon as its display is lost, which would lose videos and settings. With these two
/// handlers, the second of libX11 1.7, it continues without a display.
void outlive_display() {
  using GetDisplay = void* (*)();
  using SetHandler = void* (*)(int (*)(void* display));
  using SetExitHandler = void (*)(void* display, void (*)(void* display, void* data), void* data);
  const auto get = reinterpret_cast<GetDisplay>(dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
  const auto set = reinterpret_cast<SetHandler>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  const auto set_exit = reinterpret_cast<SetExitHandler>(dlsym(RTLD_DEFAULT, "XSetIOErrorExitHandler"));
  void* const display = get && set && set_exit ? get() : nullptr;
  if (!display) return;
  set([](void*) { return 0; });
  set_exit(
      display, [](void*, void*) { display_lost = true; }, nullptr);
}

/// Whether enough of a window there can be seen to take hold of it.
bool on_a_monitor(const std::array<int, 2>& position) {
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int x = 0, y = 0, width = 0, height = 0;
    glfwGetMonitorWorkarea(monitors[i], &x, &y, &width, &height);
    if (position[0] >= x - 8 && position[0] < x + width - 100 && position[1] >= y &&
        position[1] < y + height - 50)
      return true;
  }
  return false;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(int width, int height, const std::string& title,
                                               const std::optional<std::array<int, 2>>& position) {
  const FlushDenormals flush;  // the driver's threads inherit it
  std::unique_ptr<Window> w(new Window);
  if (!glfwInit())
    return fail(ErrorCode::no_device, "Cannot open a window: {} ({}). {}", no_display(), last_error(),
                instead);
  w->initialized_ = true;
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, gl::debug_by_default ? GLFW_TRUE : GLFW_FALSE);
  // With notice of a lost device; where a driver refuses that, without.
  glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);  // until it is in its place
  w->window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (!w->window_) {
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_NO_ROBUSTNESS);
    w->window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  }
  if (!w->window_)
    return fail(ErrorCode::no_device,
                "Cannot open a window with OpenGL 4.3 core: {}. Install a newer driver (libgl1-mesa-dri has "
                "a software one). {}",
                last_error(), instead);
  if (position && on_a_monitor(*position)) glfwSetWindowPos(w->window_, (*position)[0], (*position)[1]);
  outlive_display();
  glfwShowWindow(w->window_);
  glfwMakeContextCurrent(w->window_);
  // Under Wayland a swap that waits for the display waits for as long as the window is hidden.
  if (!position_of(w->window_)) w->image_interval_ = refresh_interval();
  glfwSwapInterval(w->image_interval_ > 0.0 ? 0 : 1);
  auto context = gl::Context::adopt_current(
      glfwGetProcAddress, {[window = w->window_] { return glfwGetCurrentContext() == window; },
                           [window = w->window_] { glfwMakeContextCurrent(window); }});
  if (!context) return fail(context.error(), "{} {}", context.error().what, instead);
  w->context_ = std::move(*context);
  w->connect();
  return w;
}

Window::~Window() {
  context_.reset();
  if (window_) glfwDestroyWindow(window_);
  if (initialized_) glfwTerminate();
}

void Window::connect() {
  glfwSetWindowUserPointer(window_, &receiver_);
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
    if (EventReceiver* r = receiver_of(window)) r->key(key, action, modifiers);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned int code_point) {
    if (EventReceiver* r = receiver_of(window)) r->character(code_point);
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int modifiers) {
    if (EventReceiver* r = receiver_of(window)) r->mouse_button(button, action, modifiers);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
    if (EventReceiver* r = receiver_of(window)) r->cursor(x, y);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double dx, double dy) {
    if (EventReceiver* r = receiver_of(window)) r->scroll(dx, dy);
  });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) {
    if (EventReceiver* r = receiver_of(window)) r->refresh();
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) {
    if (EventReceiver* r = receiver_of(window)) r->refresh();
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    if (EventReceiver* r = receiver_of(window)) r->drop({paths, paths + count});
  });
}

WindowServices Window::services() {
  WindowServices services;
  services.window = window_;
  services.clipboard = [this] {
    const char* text = glfwGetClipboardString(window_);
    return std::string(text ? text : "");
  };
  services.set_clipboard = [this](const std::string& text) { glfwSetClipboardString(window_, text.c_str()); };
  services.toggle_full_screen = [this] { toggle_full_screen(); };
  return services;
}

WindowSize Window::size() const {
  WindowSize size;
  glfwGetWindowSize(window_, &size.width, &size.height);
  glfwGetFramebufferSize(window_, &size.pixel_width, &size.pixel_height);
  return size;
}

WindowPlace Window::place() const {
  if (full_screen_) return place_;
  WindowPlace place;
  glfwGetWindowSize(window_, &place.width, &place.height);
  place.position = position_of(window_);
  return place;
}

double Window::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  // Where window units are not pixels the system scales them by itself.
  const WindowSize s = size();
  const double ratio = s.width > 0 ? static_cast<double>(s.pixel_width) / s.width : 1.0;
  return std::clamp(static_cast<double>(std::max(x, y)) / ratio, 0.75, 4.0);
}

bool Window::is_lost() {
  return display_lost;
}

bool Window::should_close() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::set_should_close(bool close) {
  glfwSetWindowShouldClose(window_, close ? GLFW_TRUE : GLFW_FALSE);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::poll(double wait) {
  if (wait > 0.0)
    glfwWaitEventsTimeout(wait);
  else
    glfwPollEvents();
}

void Window::show_image() {
  glfwSwapBuffers(window_);
}

void Window::toggle_full_screen() {
  if (full_screen_) {
    const auto [x, y] = place_.position.value_or(std::array<int, 2>{});
    glfwSetWindowMonitor(window_, nullptr, x, y, place_.width, place_.height, GLFW_DONT_CARE);
    full_screen_ = false;
    return;
  }
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  place_ = place();
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  full_screen_ = true;
}

}  // namespace aspic::app
