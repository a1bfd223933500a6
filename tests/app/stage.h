#pragma once
// The real window and app on whatever display there is, with a hand on keys and mouse.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/app.h"
#include "app/window.h"
#include "model/integrator.h"
#include "support/image_comparison.h"
#include "support/temporary_directory.h"

namespace aspic::test {

/// Where the widgets of the last image were, and what their tooltips say, by name.
class WidgetLog final : public app::WidgetWatcher {
 public:
  std::map<std::string, app::Box> boxes;
  std::map<std::string, std::string> explanations;  ///< empty for a widget without one

  void widget(const std::string& name, const app::Box& box) override { making_[name] = box; }
  void tooltip(const app::Box& box, const std::string& text) override { tooltips_.emplace_back(box, text); }
  void end_of_image() override;

 private:
  std::map<std::string, app::Box> making_;
  std::vector<std::pair<app::Box, std::string>> tooltips_;
};

/// The standard output of a command, and how it ended (waitpid) in `status`.
std::string output_of(const std::string& command, int* status = nullptr);

/// A test with the window open. Fails on any GL error that is left at its end.
class Stage : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Width and height of the window; the display has 1920 × 1080. Small, for images cost by the pixel;
  /// suites about what is where have `roomy`, in which panels stand on both sides.
  virtual std::array<int, 2> window_size() const { return {640, 400}; }
  static constexpr std::array<int, 2> roomy = {1280, 720};
  /// Whether images are drawn as on hardware.
  virtual bool full_quality() const { return false; }
  /// Opens the app on a scene, on a backend by its name (empty: automatic); before any other call.
  void open(const std::string& scene, std::vector<std::string> overrides = {}, std::string_view backend = "");
  void open(const std::string& scene, std::vector<std::string> overrides, std::string_view backend,
            const app::KeptState& kept);

  /// Ends the app as closing the window does when nothing else is left to do.
  void close() { app_.reset(); }
  /// Closes the window too, so that another program's has the screen to itself.
  void close_window() { window_.reset(); }

  app::App& app() { return *app_; }
  PlaybackSession& simulation() { return app_->simulation; }
  /// One image, so many seconds after the last.
  void frame(double apart = 1.0 / 60.0);
  /// Images, so many seconds apart; at rest as many more, in no time, as the fine image needs.
  void frames(int count, double apart = 1.0 / 60.0);
  /// Images until the run is at that step or beyond; a failure after ten thousand.
  void frames_to_step(std::uint64_t step) {
    frames_until([&] { return simulation().step() >= step; });
  }
  /// Images until a condition holds; a failure after ten thousand.
  template <class Condition>
  void frames_until(Condition condition) {
    for (int i = 0; !condition(); ++i) {
      ASSERT_LT(i, 10000) << "stuck at step " << simulation().step();
      frames(1);
    }
  }
  /// Images until the camera stands still.
  void frames_to_rest();

  /// The device is lost, as the `chance`-th look for it from now on finds (0: the next); images go on until
  /// the window is replaced.
  void lose_device(std::uint64_t chance);
  gl::Context& context() { return window_->context(); }

  void press(int key, int modifiers = 0);
  void type(char32_t character);
  void drag(int button, double x, double y, double dx, double dy, int modifiers = 0);
  /// Scrolls the panels until a widget can be seen; a failure if it is not there.
  void bring_into_sight(const std::string& widget);
  /// Clicks the middle of a widget by name, scrolled into sight; a failure if it is not there.
  void click(const std::string& widget);
  bool has(const std::string& widget) const { return widgets().contains(widget); }
  const std::map<std::string, app::Box>& widgets() const { return log_.boxes; }
  const std::map<std::string, std::string>& explanations() const { return log_.explanations; }
  double middle_x() { return app_->view.box.center_x(); }
  double middle_y() { return app_->view.box.center_y(); }

  /// Pixels of a window unit, as on a dense display under Wayland; the window has as many pixels as before.
  double pixels_per_unit = 1.0;
  /// Another size of the window; takes two images.
  void resize(int width, int height);
  /// Pixels of the window, RGB, rows from the bottom.
  std::vector<unsigned char> pixels() const;
  /// The same as an image, rows from the top.
  Image image() const;
  /// The clipboard, which tests keep to themselves.
  std::string clipboard;
  int full_screen_toggles = 0;
  const std::filesystem::path& directory() const { return temporary_->path(); }

 private:
  std::unique_ptr<TemporaryDirectory> temporary_;
  std::filesystem::path home_;
  std::unique_ptr<app::Window> window_;
  std::vector<std::string> severe_;  // messages of the driver
  WidgetLog log_;
  std::unique_ptr<app::App> app_;
  int held_modifiers_ = 0;  // by press(), until the next image
};

/// Hash of the reference's state of a scene after some steps.
std::string reference_hash(const Scene& scene, std::uint64_t steps);

}  // namespace aspic::test
