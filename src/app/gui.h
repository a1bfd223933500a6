#pragma once
// Dear ImGui's surroundings: context, font, colors, and input as it comes from the window's callbacks.
#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "base/result.h"

struct GLFWwindow;
struct ImFont;

namespace aspic::app {

/// What the panels ask of the window system.
struct WindowServices {
  GLFWwindow* window = nullptr;  ///< the one that they are drawn in; never null
  std::function<std::string()> clipboard;
  std::function<void(const std::string&)> set_clipboard;
  std::function<void()> toggle_full_screen;
};

/// A place in the window [window units from the left and the top].
struct Box {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  double center_x() const { return 0.5 * (left + right); }
  double center_y() const { return 0.5 * (top + bottom); }
  friend bool operator==(const Box&, const Box&) = default;
  bool contains(double x, double y) const { return x >= left && x < right && y >= top && y < bottom; }
};

/// Sizes of a window: in its own units and in pixels.
struct WindowSize {
  int width = 0, height = 0;
  int pixel_width = 0, pixel_height = 0;
  double pixels_per_unit() const { return static_cast<double>(pixel_width) / width; }
};

/// Sees the widgets of each image as they are made: for tests and tools.
class WidgetWatcher {
 public:
  virtual ~WidgetWatcher() = default;
  /// A widget was made under that name.
  virtual void widget(const std::string& name, const Box& box) = 0;
  /// What the tooltip of the widget in that box says, shown or not.
  virtual void tooltip(const Box& box, const std::string& text) = 0;
  /// All widgets of an image were made.
  virtual void end_of_image() = 0;
};

/// A key that went down, repeats or came up, or a character that was typed.
struct KeyEvent {
  int key = -1, action = 0, modifiers = 0;  ///< as GLFW names them
  unsigned int character = 0;               ///< 0: it is a key
};

/// Owns the ImGui context; one at a time. Positions are in window units, as GLFW gives them.
class Gui {
 public:
  /// `scale` is that of the display: 1 for 96 dots per inch. The GL context must be current, here and later.
  /// `commands`, and `watcher` if there is one, must outlive it. Error (no_device): the shaders of the panels
  /// are refused.
  static Result<std::unique_ptr<Gui>> create(double scale, WindowServices services, const Commands& commands,
                                             WidgetWatcher* watcher = nullptr);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // ---- events; keys, buttons, actions and modifiers as GLFW names them ----
  void key(const KeyEvent& event);
  /// Whether the image to come can take that key in addition to those it has: one that was pressed and let
  /// go of between two images would be lost, and of characters and keys that edit the order.
  bool ready_for(const KeyEvent& event) const;
  void mouse_button(int button, int action);
  void cursor(double x, double y);
  void scroll(double dx, double dy);
  /// Whether a text field has the keyboard, or a panel the mouse.
  bool takes_keyboard() const;
  /// Whether a list of choices is open, which keys then move through.
  static bool list_is_open();
  bool takes_mouse() const;

  /// Begins the panels of an image of a window that is not empty, `dt` ≥ 0 after the last [s].
  void begin(const WindowSize& size, double dt);
  /// Draws them into the current framebuffer.
  void end();

  /// Of everything in the panels: the display's, times the text size.
  double scale() const { return display_scale_ * text_size_; }
  /// Another size of text and panels, a factor > 0 on the display's; takes effect with the next begin().
  void set_text_size(double size) { wanted_text_size_ = size; }
  /// The image that is made shows something under way: the next one will differ without an event.
  void keep_awake() { awake_ = true; }
  bool awake() const { return awake_; }
  /// Where the widgets stay that the last image had there, although rows are added above [window units].
  std::optional<float> held_y;
  /// Three times as tall as the text, for figures and letters alone.
  ImFont* large_font() const { return large_font_; }
  const WindowServices& services() const { return services_; }

  /// What keys do, and buttons that have a key.
  const Commands& commands() const { return commands_; }

  /// Names the widget just made, for the watcher: the name is made only if there is one.
  template <class... Arguments>
  void mark(fmt::format_string<Arguments...> name, Arguments&&... arguments) const {
    if (watcher_) watcher_->widget(fmt::format(name, std::forward<Arguments>(arguments)...), last_item());
  }
  /// The same of what is no widget of ImGui's.
  void mark_box(const std::string& name, const Box& box) const {
    if (watcher_) watcher_->widget(name, box);
  }
  /// Tells the watcher what the tooltip of the widget just made says. True if it is time to show it: the
  /// mouse has rested on the widget and nothing is held or typed.
  bool explain(std::string_view text, std::string_view keys);
  /// The one whose panels are being made, between begin() and end().
  static Gui& current();

 private:
  Gui(double scale, WindowServices services, const Commands& commands, WidgetWatcher* watcher)
      : display_scale_(scale), services_(std::move(services)), commands_(commands), watcher_(watcher) {}
  static Box last_item();
  void set_look();
  double display_scale_, text_size_ = 1.0, wanted_text_size_ = 1.0, pixels_per_unit_ = 1.0;
  WindowServices services_;
  const Commands& commands_;
  WidgetWatcher* watcher_;
  ImFont* large_font_ = nullptr;
  double mouse_x_ = -1e9, mouse_y_ = -1e9;
  bool pressed_[5] = {}, held_[5] = {};
  std::vector<int> changed_;  // keys that went down or came up since the last image
  bool awake_ = false;
  bool edited_ = false;                            // one that went down edits text
  Box rested_on_;                                  // the widget under the mouse
  double rested_since_ = 0.0, rested_seen_ = 0.0;  // ImGui's time
};

}  // namespace aspic::app
