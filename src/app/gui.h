#pragma once
// Dear ImGui's surroundings: context, font, colours, and input as it comes from the window's callbacks.
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "base/result.h"

namespace aspic::app {

/// What the panels ask of the window system.
struct WindowServices {
  std::function<std::string()> clipboard;
  std::function<void(const std::string&)> set_clipboard;
  std::function<void()> toggle_full_screen;
};

/// A place in the window [window units from the left and the top].
struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  double centre_x() const { return 0.5 * (left + right); }
  double centre_y() const { return 0.5 * (top + bottom); }
  bool contains(double x, double y) const { return x >= left && x < right && y >= top && y < bottom; }
};

/// Owns the ImGui context; one at a time. Positions are in window units, as GLFW gives them.
class Gui {
 public:
  /// `scale` is that of the display: 1 for 96 dots per inch. The GL context must be current, here and later.
  /// Error (no_device): the shaders of the panels are refused.
  static Result<std::unique_ptr<Gui>> create(double scale, WindowServices services);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // ---- events; keys, buttons, actions and modifiers as GLFW names them ----
  void key(int key, int action, int modifiers);
  void character(unsigned int code_point);
  void mouse_button(int button, int action);
  void cursor(double x, double y);
  void scroll(double dx, double dy);
  /// Whether a text field has the keyboard, or a panel the mouse.
  bool takes_keyboard() const;
  bool takes_mouse() const;

  /// Begins the panels of a picture; sizes in window units, `pixels_per_unit` of the framebuffer.
  void begin(double width, double height, double pixels_per_unit, double dt);
  /// Draws them into the current framebuffer.
  void end();

  double scale() const { return scale_; }
  const WindowServices& services() const { return services_; }

  /// Remembers where the widget just made stands, under a name; of the picture under way.
  void mark(const std::string& name);
  /// Where widgets stood in the last picture, by name: for tests and tools.
  const std::map<std::string, Box>& widgets() const { return widgets_; }

 private:
  Gui(double scale, WindowServices services) : scale_(scale), services_(std::move(services)) {}
  double scale_;
  WindowServices services_;
  std::string clipboard_;
  bool pressed_[5] = {}, held_[5] = {};
  std::map<std::string, Box> widgets_, marking_;
};

}  // namespace aspic::app
