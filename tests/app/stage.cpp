#include "app/stage.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/revival.h"
#include "cpu_reference/reference_solver.h"

namespace aspic::test {

void WidgetLog::end_of_image() {
  boxes = std::move(making_);
  making_ = {};
  explanations.clear();
  for (const auto& [name, box] : boxes) {
    const auto found = std::ranges::find(tooltips_, box, &std::pair<app::Box, std::string>::first);
    explanations[name] = found == tooltips_.end() ? std::string() : found->second;
  }
  tooltips_.clear();
}

std::string output_of(const std::string& command, int* status) {
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  std::array<char, 4096> part;
  for (std::size_t got; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), got);
  const int ended = ::pclose(pipe);
  if (status) *status = ended;
  return text;
}

void Stage::SetUp() {
  temporary_ = std::make_unique<TemporaryDirectory>();
  home_ = std::filesystem::current_path();
  // Screenshots land where the program was started.
  std::filesystem::current_path(directory());
  const auto [width, height] = window_size();
  auto window = app::Window::create(width, height, "test");
  ASSERT_TRUE(window.ok()) << window.error().message();
  window_ = std::move(*window);
  window_->context().set_message_sink([this](const gl::DebugMessage& message) {
    if (message.severe) severe_.push_back(message.text);
  });
}

void Stage::TearDown() {
  app_.reset();
  if (window_) {
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    // Among them errors that a solver came across.
    for (const std::string& message : severe_) ADD_FAILURE() << "The driver reported: " << message;
  }
  window_.reset();
  std::filesystem::current_path(home_);
}

void Stage::open(const std::string& scene, std::vector<std::string> overrides, std::string_view backend) {
  app::KeptState never_closed;
  never_closed.greeted = true;
  never_closed.pace = Pace::steps_per_frame;  // as many steps an image, however long it takes
  open(scene, std::move(overrides), backend, never_closed);
}

void Stage::open(const std::string& scene, std::vector<std::string> overrides, std::string_view backend,
                 const app::KeptState& kept) {
  app::WindowServices services = window_->services();
  services.clipboard = [this] { return clipboard; };
  services.set_clipboard = [this](const std::string& text) { clipboard = text; };
  services.toggle_full_screen = [this] { ++full_screen_toggles; };
  // Unfolded, so that tests reach all.
  app::KeptState unfolded = kept;
  for (const char* const fold : {"View: more", "Energy: momentum", "Springs: by type"})
    unfolded.layout.sections.emplace(fold, true);
  close();  // one application at a time in a window
  auto made = app::App::create(window_->context(),
                               {.scene = scene,
                                .overrides = std::move(overrides),
                                .backend = find_backend(backend),
                                .kept = unfolded,
                                .full_quality = full_quality(),
                                .watcher = &log_},
                               1.0, services);
  ASSERT_TRUE(made.ok()) << made.error().message();
  app_ = std::move(*made);
  window_->set_receiver(app_.get());
  frames(2);
}

void Stage::frame(double apart) {
  // Nobody holds them for longer: with Ctrl down the wheel scrolls no panel.
  for (const auto& [bit, key] : {std::pair{GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL},
                                 {GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT},
                                 {GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT}})
    if ((held_modifiers_ & bit) != 0) app_->key(key, GLFW_RELEASE, 0);
  held_modifiers_ = 0;
  app::WindowSize size = window_->size();
  size.width = static_cast<int>(std::lround(size.pixel_width / pixels_per_unit));
  size.height = static_cast<int>(std::lround(size.pixel_height / pixels_per_unit));
  const Status drawn = app_->frame(size, apart);
  ASSERT_TRUE(drawn.ok()) << drawn.error().message();
  window_->show_image();
}

void Stage::frames(int count, double apart) {
  for (int i = 0; i < count && !HasFatalFailure(); ++i) frame(apart);
  while ((app_->image.refining() || app_->comparison_view.refining()) && !HasFatalFailure()) frame(0.0);
}

void Stage::lose_device(std::uint64_t chance) {
  context().inject_fault(gl::Fault::lost_context, chance);
  for (int i = 0;; ++i) {
    ASSERT_LT(i, 1000) << "the device was never missed";
    const Status drawn = app_->frame(window_->size(), 1.0 / 60.0);
    if (drawn) continue;
    ASSERT_TRUE(context().lost());
    auto other = app::replace_window(*app_, std::move(window_), drawn.error());
    ASSERT_TRUE(other.ok()) << other.error().message();
    window_ = std::move(*other);
    return;
  }
}

void Stage::frames_to_rest() {
  for (int i = 0; app_->view.camera.shown() != app_->view.camera.goal(); ++i) {
    ASSERT_LT(i, 600);
    frames(1);
  }
}

void Stage::press(int key, int modifiers) {
  app_->key(key, GLFW_PRESS, modifiers);
  app_->key(key, GLFW_RELEASE, modifiers);
  held_modifiers_ |= modifiers;
}

void Stage::type(char32_t character) {
  app_->character(static_cast<unsigned int>(character));
}

void Stage::drag(int button, double x, double y, double dx, double dy, int modifiers) {
  app_->cursor(x, y);
  frames(1);
  app_->mouse_button(button, GLFW_PRESS, modifiers);
  frames(1);
  app_->cursor(x + 0.5 * dx, y + 0.5 * dy);
  frames(1);
  app_->cursor(x + dx, y + dy);
  app_->mouse_button(button, GLFW_RELEASE, modifiers);
}

void Stage::bring_into_sight(const std::string& widget) {
  constexpr double margin = 12.0;
  for (int i = 0; i < 200; ++i) {
    const auto found = widgets().find(widget);
    ASSERT_NE(found, widgets().end()) << "no widget " << widget;
    const app::Box box = found->second, view = app_->view.box;
    // What floats over the image, and the line below all, never needs to be scrolled.
    if (box.center_x() > view.left && box.center_x() < view.right) return;
    // The panels reach down as far as the bar of the history under the image.
    if (box.center_y() > margin && box.center_y() < widgets().at("timeline").bottom) return;
    app_->cursor(box.center_x(), view.center_y());
    frames(1);
    app_->scroll(0, box.center_y() < margin ? 1 : -1);
    frames(1);
  }
  FAIL() << widget << " cannot be scrolled to";
}

void Stage::click(const std::string& widget) {
  bring_into_sight(widget);
  const auto found = widgets().find(widget);
  ASSERT_NE(found, widgets().end()) << "no widget " << widget;
  app_->cursor(found->second.center_x(), found->second.center_y());
  frames(1);
  app_->mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  frames(1);
  app_->mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  // The panel scrolls by as much as the rows of an added body take.
  frames(widget.ends_with("/add") ? 3 : 2);
}

void Stage::resize(int wide, int high) {
  glfwSetWindowSize(glfwGetCurrentContext(), wide, high);
  for (int i = 0; window_->size().width != wide || window_->size().height != high; ++i) {
    ASSERT_LT(i, 1000);
    window_->poll(0.01);
  }
  frames(2);
}

std::vector<unsigned char> Stage::pixels() const {
  const app::WindowSize size = window_->size();
  std::vector<unsigned char> rgb(3 * static_cast<std::size_t>(size.pixel_width) *
                                 static_cast<std::size_t>(size.pixel_height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size.pixel_width, size.pixel_height, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return rgb;
}

Image Stage::image() const {
  const app::WindowSize size = window_->size();
  const auto below = pixels();
  Image image{size.pixel_width, size.pixel_height, std::vector<std::byte>(below.size())};
  const std::size_t row = 3 * static_cast<std::size_t>(size.pixel_width);
  for (std::size_t at = 0; at < below.size(); ++at)
    image.rgb[below.size() - row - at / row * row + at % row] = static_cast<std::byte>(below[at]);
  return image;
}

std::string reference_hash(const Scene& scene, std::uint64_t steps) {
  const auto model = build_model(scene.model);
  EXPECT_TRUE(model.ok());
  const auto solver = make_reference_solver(*model, Precision::single);
  EXPECT_TRUE(solver.ok());
  EXPECT_TRUE((*solver)->advance(steps).ok());
  const auto state = (*solver)->state();
  EXPECT_TRUE(state.ok());
  return state_hash_text(*state);
}

}  // namespace aspic::test
