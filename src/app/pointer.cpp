#include "app/pointer.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/inputs.h"
#include "model/terrain.h"

namespace aspic::app {
namespace {

/// Two presses are one double click if they come this close [s, window units].
constexpr double double_click_time = 0.400, double_click_reach = 4.0;

/// Contacts of a ball: terrain by name, other balls and particles by number.
std::string contacts_of_ball(const Model& model, const State& state, std::uint32_t b) {
  const Ball& ball = model.balls[b];
  if (!ball.launched(state.step)) return "not launched yet";
  const Vec3 x = state.ball_position[b];
  const double reach = ball.radius + model.contact.distance;
  std::string words;
  const auto add = [&](const std::string& what) { words += (words.empty() ? "touches " : ", ") + what; };
  for (const Terrain& t : model.terrain) {
    if (signed_distance(terrain_at(t, model.simulation.timestep, state.step), x) < reach)
      add(std::string(name_of(t.shape)));
  }
  const auto count = [&](std::ptrdiff_t n, const char* what) {
    if (n > 0) add(fmt::format("{} {}{}", n, what, n > 1 ? "s" : ""));
  };
  std::ptrdiff_t balls = 0;
  for (std::uint32_t i = 0; i < model.ball_count(); ++i) {
    if (i != b && model.balls[i].launched(state.step) &&
        length(state.ball_position[i] - x) < reach + model.balls[i].radius)
      ++balls;
  }
  count(balls, "ball");
  count(std::ranges::count_if(state.position, [&](const Vec3& p) { return length(p - x) < reach; }),
        "particle");
  return words;
}

}  // namespace

void Pointer::press(int button, int modifiers, bool on_panel) {
  if (drag_button_ >= 0 || on_panel || !view_.whole.contains(x_, y_)) return;
  if (modifiers & GLFW_MOD_CONTROL) {
    if (!hovered_) return;
    const Hovered& h = *hovered_;
    if (button == GLFW_MOUSE_BUTTON_LEFT)
      h.ball ? hands_.begin_ball_pull(h.particle, h.position) : hands_.begin_pull(h.particle, h.position);
    if (button == GLFW_MOUSE_BUTTON_RIGHT) h.ball ? hands_.refuse_pin() : hands_.toggle_pin(h.particle);
    return;
  }
  if (button == GLFW_MOUSE_BUTTON_LEFT && modifiers == 0) center_wanted_ = is_double_click();
  drag_button_ = button;
  drag_pans_ = button != GLFW_MOUSE_BUTTON_LEFT || (modifiers & GLFW_MOD_SHIFT) != 0;
}

void Pointer::release(int button) {
  if (button == drag_button_) drag_button_ = -1;
  if (button == GLFW_MOUSE_BUTTON_LEFT) hands_.end_pull();
}

void Pointer::move(double x, double y) {
  const double dx = (x - x_) / view_.height(), dy = (y - y_) / view_.height();
  if (drag_button_ >= 0 && drag_pans_)
    view_.camera.pan(dx, dy);
  else if (drag_button_ >= 0)
    view_.camera.orbit(dx, dy);
  x_ = x;
  y_ = y;
  hands_.move_pull(x_ - view_.box.left, y_ - view_.box.top);
}

bool Pointer::scroll(double notches, bool on_panel) {
  if (on_panel || !view_.whole.contains(x_, y_)) return false;
  const auto [x, y] = view_.within(x_, y_);
  view_.camera.zoom(notches, (x - 0.5 * view_.width()) / view_.height(),
                    (y - 0.5 * view_.height()) / view_.height(), view_.seen().fov);
  return true;
}

Ray Pointer::sight(bool on_panel) const {
  if (on_panel || !view_.whole.contains(x_, y_))
    return view_.sight(view_.box.center_x(), view_.box.center_y());
  return view_.sight(x_, y_);
}

void Pointer::describe(std::uint32_t particle) {
  const Model& model = simulation_.model();
  const State& state = simulation_.snapshot();
  if (!incident_ || incident_model_ != simulation_.present().model_number()) {
    incident_.emplace(model);
    body_contacts_ = std::make_unique<BodyContactForces>(model);
    incident_model_ = simulation_.present().model_number();
  }
  Hovered h;
  h.particle = particle;
  h.position = state.position[particle];
  h.velocity = state.velocity[particle];
  body_contacts_->find(*incident_, state, simulation_.inputs());
  h.force = particle_force(model, *incident_, state, particle, simulation_.inputs(), body_contacts_.get());
  h.mass = model.mass[particle];
  h.pinned = inverse_mass_of(model, simulation_.inputs(), particle) == 0.0;
  hovered_ = std::move(h);
}

void Pointer::describe_ball(std::uint32_t b) {
  const Model& model = simulation_.model();
  const State& state = simulation_.snapshot();
  const Ball& ball = model.balls[b];
  Hovered h;
  h.ball = true;
  h.particle = b;
  h.position = state.ball_position[b];
  h.velocity = state.ball_velocity[b];
  h.angular_velocity = state.ball_angular_velocity[b];
  h.force = ball_force(model, state, b, simulation_.inputs());
  h.mass = ball.mass;
  h.radius = ball.radius;
  h.contact = contacts_of_ball(model, state, b);
  hovered_ = std::move(h);
}

void Pointer::find_hovered() {
  hovered_.reset();
  if (const auto& hand = simulation_.hand())
    return hand->ball ? describe_ball(hand->particle) : describe(hand->particle);
  if (!asked_ || !image_.is_of_model()) return;
  const PickAnswer answer = image_.picked();
  if (answer.request < asked_->first) return;
  if (center_wanted_ && answer.request == asked_->last) {
    center_wanted_ = false;
    if (answer.what) center_on(*answer.what);
  }
  if (drag_button_ >= 0 || !answer.what) return;
  if (answer.what->kind == PickKind::particle) describe(answer.what->index);
  if (answer.what->kind == PickKind::ball && answer.what->index < simulation_.model().ball_count())
    describe_ball(answer.what->index);
}

Status Pointer::mark_and_ask(bool on_panel) {
  if (!image_.is_of_model()) return {};
  if (hovered_ && !hovered_->ball) {
    ASPIC_CHECK(image_.mark(hovered_->particle));
  }
  const bool free = drag_button_ < 0 || center_wanted_;
  if (!free || simulation_.hand() || on_panel || !image_.shown().contains(x_, y_)) {
    asked_.reset();
    center_wanted_ = false;
    return {};
  }
  if (asked_ && asked_->x == x_ && asked_->y == y_ && asked_->image == image_.number()) return {};
  ASPIC_TRY(const auto number, image_.request_pick(x_, y_));
  asked_ = Question{x_, y_, image_.number(), asked_ ? asked_->first : number, number};
  return {};
}

bool Pointer::is_double_click() {
  const double time = clock();
  const bool twice = time - pressed_time_ <= double_click_time &&
                     std::hypot(x_ - pressed_x_, y_ - pressed_y_) <= double_click_reach;
  // A third press is a first one again.
  pressed_time_ = twice ? -1e9 : time;
  pressed_x_ = x_;
  pressed_y_ = y_;
  if (twice) asked_.reset();  // what counts is what is there now
  return twice;
}

void Pointer::center_on(const Picked& picked) {
  const State& state = simulation_.snapshot();
  Vec3 point = picked.point;
  if (picked.kind == PickKind::particle) point = state.position[picked.index];
  if (picked.kind == PickKind::ball && picked.index < state.ball_position.size())
    point = state.ball_position[picked.index];
  view_.camera.center(point - view_.offset());
}

void Pointer::forget() {
  hands_.end_pull();
  asked_.reset();
  hovered_.reset();
  drag_button_ = -1;
}

}  // namespace aspic::app
