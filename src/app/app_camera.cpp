// The part of App that sets the camera: to the bodies, to and from the clipboard.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "app/app.h"
#include "scene/load.h"
#include "scene/write.h"

namespace aspic::app {

void App::take_on(const KeptState& kept, const std::vector<std::string>& overrides) {
  layout_ = kept.layout;
  gui_->set_text_size(layout_.text_size);
  simulation_->pace = kept.pace;
  simulation_->speed = kept.speed;
  film_settings_ = {kept.film_format, kept.film_fps, kept.film_text, ""};
  cameras_ = kept.cameras;
  const auto sets_camera = [](const std::string& set) { return set.starts_with("view.camera"); };
  if (std::ranges::none_of(overrides, sets_camera)) recall_camera();
}

KeptState App::kept_state() const {
  KeptState kept;
  kept.layout = layout_;
  kept.pace = simulation_->pace;
  kept.speed = simulation_->speed;
  kept.film_format = film_settings_.format;
  kept.film_fps = film_settings_.fps;
  kept.film_text = film_settings_.text;
  kept.cameras = cameras_;
  const CameraSettings camera = camera_.goal();
  app::keep_camera(kept.cameras, camera_key(editor_.source()),
                   camera == camera_.home() ? std::nullopt : std::optional(camera));
  return kept;
}

void App::keep_camera() {
  cameras_ = kept_state().cameras;
}

void App::recall_camera() {
  const auto kept = std::ranges::find(cameras_, camera_key(editor_.source()), &KeptCamera::scene);
  if (kept != cameras_.end()) camera_.jump_to(kept->camera);
}

void App::frame_bodies() {
  if (const Status read = simulation_->refresh_snapshot(); !read) return tell(read);
  const State& state = simulation_->snapshot();
  if (state.position.empty() && state.ball_position.empty()) return;
  Vec3 low = state.position.empty() ? state.ball_position.front() : state.position.front(), high = low;
  const auto take_in = [&](const Vec3& x, double radius) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis] - radius);
      high[axis] = std::max(high[axis], x[axis] + radius);
    }
  };
  for (const Vec3& x : state.position) take_in(x, 0.0);
  for (std::size_t i = 0; i < state.ball_position.size(); ++i)
    take_in(state.ball_position[i], simulation_->model().balls[i].radius);
  const double height = std::max(viewport_.bottom - viewport_.top, 1.0);
  camera_.frame(0.5 * (low + high), 0.5 * length(high - low), (viewport_.right - viewport_.left) / height);
}

void App::copy_camera() {
  const CameraSettings c = camera_.goal();
  const std::string text = fmt::format("camera = {{ position = {}, target = {}, fov = {} }}",
                                       toml_value(c.position), toml_value(c.target), toml_value(c.fov));
  if (gui_->services().set_clipboard) gui_->services().set_clipboard(text);
  tell("The camera is on the clipboard, as a line for [view] of a scene file.");
}

void App::paste_camera() {
  std::string text = gui_->services().clipboard ? gui_->services().clipboard() : std::string();
  const std::size_t brace = text.find('{');
  text = text.find("camera") == std::string::npos || brace == std::string::npos ? "" : text.substr(brace);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.empty()) {
    return tell(
        "The clipboard holds no camera. One looks like camera = { position = [10.0, 6.0, 14.0], target = "
        "[0.0, 2.0, 0.0], fov = 45.0 }.",
        true);
  }
  const std::vector<std::string> set = {"view.camera=" + text};
  const auto scene = with_overrides(editor_.scene(), set);
  if (!scene) return tell(scene.error());
  camera_.jump_to(scene->view.camera);
}

}  // namespace aspic::app
