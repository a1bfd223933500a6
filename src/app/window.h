#pragma once
// A GLFW window with an OpenGL 4.3 core context, its events handed to a receiver.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/gui.h"
#include "app/kept_state.h"
#include "base/result.h"
#include "gpu/context.h"

struct GLFWwindow;

namespace aspic::app {

/// Takes what GLFW's callbacks bring, in their words (GLFW/glfw3.h). Positions in window units.
class EventReceiver {
 public:
  virtual ~EventReceiver() = default;
  virtual void key(int key, int action, int modifiers) = 0;
  virtual void character(unsigned int code_point) = 0;
  virtual void mouse_button(int button, int action, int modifiers) = 0;
  virtual void cursor(double x, double y) = 0;
  virtual void scroll(double dx, double dy) = 0;
  virtual void drop(const std::vector<std::string>& paths) = 0;
  /// What the window shows was lost, or has another size.
  virtual void refresh() = 0;
};

/// One window; one at a time in a process.
class Window {
 public:
  /// Opens a window of that size [window units] and makes its context current. Error (no_device): no display,
  /// or no OpenGL 4.3; says what to do instead.
  /// It is placed at `position` [screen units] if that is still on a monitor; otherwise the system chooses.
  static Result<std::unique_ptr<Window>> create(int width, int height, const std::string& title,
                                                const std::optional<std::array<int, 2>>& position = {});
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  gl::Context& context() { return *context_; }
  /// Events go here from now on; null ends that.
  void set_receiver(EventReceiver* receiver) { receiver_ = receiver; }
  WindowServices services();
  WindowSize size() const;
  /// Of a full screen that to come back to. Wayland has no positions.
  WindowPlace place() const;
  double content_scale() const;
  /// Whether the display is gone, and every window with it.
  static bool is_lost();
  bool should_close() const;
  void set_should_close(bool close);
  void set_title(const std::string& title);
  /// Hands over events; waits for one up to `wait` seconds where that is above 0.
  void poll(double wait);
  void show_image();
  /// How far images are apart at least [s]; 0: show_image() waits for the display.
  double image_interval() const { return image_interval_; }
  bool full_screen() const { return full_screen_; }
  void toggle_full_screen();

 private:
  Window() = default;
  void connect();
  GLFWwindow* window_ = nullptr;
  bool initialized_ = false, full_screen_ = false;
  double image_interval_ = 0.0;
  WindowPlace place_;  // to come back to from full screen
  std::shared_ptr<gl::Context> context_;
  EventReceiver* receiver_ = nullptr;
};

}  // namespace aspic::app
