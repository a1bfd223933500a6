#pragma once
// Dear ImGui's surroundings: context, font, colours, and input as it comes from the window's callbacks.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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
  friend bool operator==(const Box&, const Box&) = default;
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

  /// Of everything in the panels: the display's, times the text size.
  double scale() const { return display_scale_ * text_size_; }
  /// Another size of text and panels, a factor > 0 on the display's; takes effect with the next begin().
  void set_text_size(double size) { wanted_text_size_ = size; }
  const WindowServices& services() const { return services_; }

  /// Remembers where the widget just made stands, under a name; of the picture under way.
  void mark(const std::string& name);
  /// Where widgets stood in the last picture, by name: for tests and tools.
  const std::map<std::string, Box>& widgets() const { return widgets_; }
  /// Remembers what the tooltip of the widget just made says, shown or not.
  void explain(std::string text);
  /// What the tooltips of the last picture's marked widgets say, by name; empty for one without any.
  const std::map<std::string, std::string>& explanations() const { return explanations_; }
  /// The one whose panels are being made, between begin() and end().
  static Gui& current();

 private:
  Gui(double scale, WindowServices services) : display_scale_(scale), services_(std::move(services)) {}
  void set_look();
  double display_scale_, text_size_ = 1.0, wanted_text_size_ = 1.0;
  WindowServices services_;
  std::string clipboard_;
  bool pressed_[5] = {}, held_[5] = {};
  std::map<std::string, Box> widgets_, marking_;
  std::map<std::string, std::string> explanations_;
  std::vector<std::pair<Box, std::string>> explaining_;
};

}  // namespace aspic::app
