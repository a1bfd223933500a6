#include "app/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "aspic/scene.h"
#include "scene/follow.h"
#include "scene/write.h"

namespace aspic::app {

CameraSettings View::seen(const Vec3& offset) const {
  return fitted(moved(camera.shown(), offset), width(), height());
}

const OtherImage* View::other_at(double x, double y) const {
  const auto found =
      std::ranges::find_if(others, [&](const OtherImage& other) { return other.box.contains(x, y); });
  return found == others.end() ? nullptr : &*found;
}

std::array<double, 2> View::within(double x, double y) const {
  const OtherImage* const other = other_at(x, y);
  const Box& image = other ? other->box : box;
  return {x - image.left, y - image.top};
}

Ray View::sight(double x, double y) const {
  const OtherImage* const other = other_at(x, y);
  const auto [right, down] = within(x, y);
  return lens(other ? other->offset : offset_).ray_through(right, down);
}

void View::follow(const std::optional<std::string>& what, const Vec3& offset) {
  if (followed_ && *followed_ != what) camera.shift(offset_ - offset);
  followed_ = what;
  offset_ = offset;
}

bool View::sees_bodies(const State& state) const {
  const Camera now = lens();
  const glm::mat4 through = now.projection() * now.view();
  const auto seen = [&](const Vec3& x) {
    const glm::vec4 p =
        through * glm::vec4(static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z), 1.0f);
    return p.w > 0.0f && std::abs(p.x) < p.w && std::abs(p.y) < p.w;
  };
  return std::ranges::any_of(state.position, seen) || std::ranges::any_of(state.ball_position, seen);
}

Camera View::lens(const Vec3& offset) const {
  return {seen(offset), static_cast<int>(width()), static_cast<int>(height())};
}

void View::frame_bodies(const Model& model, const State& state) {
  if (state.position.empty() && state.ball_position.empty()) return;
  Vec3 low = state.position.empty() ? state.ball_position.front() : state.position.front(), high = low;
  const auto include = [&](const Vec3& x, double radius) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis] - radius);
      high[axis] = std::max(high[axis], x[axis] + radius);
    }
  };
  for (const Vec3& x : state.position) include(x, 0.0);
  for (std::size_t i = 0; i < state.ball_position.size(); ++i)
    include(state.ball_position[i], model.balls[i].radius);
  camera.frame(0.5 * (low + high) - offset_, 0.5 * length(high - low),
               std::max(width() / height(), narrowest));
}

std::vector<KeptCamera> View::kept_with(const std::string& source) const {
  std::vector<KeptCamera> cameras = kept;
  const CameraSettings goal = camera.goal();
  app::keep_camera(cameras, camera_key(source), goal == camera.home() ? std::nullopt : std::optional(goal));
  return cameras;
}

void View::recall_camera(const std::string& source) {
  const auto found = std::ranges::find(kept, camera_key(source), &KeptCamera::scene);
  recalled = found != kept.end();
  if (recalled) camera.jump_to(found->camera);
}

void copy_camera(const View& view, const WindowServices& services, Messages& messages) {
  const CameraSettings c = view.camera.goal();
  const std::string text =
      fmt::format("camera = {{ position = {}, target = {}, fov = {}, projection = \"{}\" }}",
                  toml_value(c.position), toml_value(c.target), toml_value(c.fov), name_of(c.projection));
  if (services.set_clipboard) services.set_clipboard(text);
  messages.info("Copied the camera to the clipboard, as a line for [view] of a scene file.");
}

void paste_camera(View& view, const Scene& scene, const WindowServices& services, Messages& messages) {
  std::string text = services.clipboard ? services.clipboard() : std::string();
  const std::size_t brace = text.find('{');
  text = text.find("camera") == std::string::npos || brace == std::string::npos ? "" : text.substr(brace);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.empty()) {
    return messages.refuse(
        "The clipboard holds no camera. Copy a line such as camera = { position = [10.0, 6.0, 14.0], target "
        "= [0.0, 2.0, 0.0], fov = 45.0 }.");
  }
  const std::vector<std::string> set = {"view.camera=" + text};
  const auto pasted = with_overrides(scene, set);
  if (pasted)
    view.camera.jump_to(pasted->view.camera);
  else
    messages.refuse(pasted.error());
}

}  // namespace aspic::app
