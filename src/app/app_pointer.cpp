// The part of App that knows what the mouse points at: hovering, marks on particles, centring.
#include <chrono>
#include <cmath>

#include "app/app.h"

namespace aspic::app {
namespace {

/// Two presses are one double click if they come this close [s, window units].
constexpr double double_click_time = 0.400, double_click_reach = 4.0;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void App::describe(std::uint32_t particle) {
  const Model& model = simulation_->model();
  const State& state = simulation_->snapshot();
  if (!incident_ || incident_model_ != simulation_->model_number()) {
    incident_.emplace(model);
    incident_model_ = simulation_->model_number();
  }
  hovered_ = Hovered{particle,
                     state.position[particle],
                     state.velocity[particle],
                     particle_force(model, *incident_, state, particle, simulation_->hand()),
                     model.mass[particle],
                     model.inverse_mass[particle] == 0.0};
}

void App::find_hovered() {
  hovered_.reset();
  if (simulation_->hand()) return describe(simulation_->hand()->particle);
  // Indices of a picture mean those of its model.
  if (!asked_ || drawn_model_ != simulation_->model_number()) return;
  const PickAnswer answer = renderer_->picked();
  if (answer.request < asked_->first) return;
  if (centre_wanted_ && answer.request == asked_->last) {
    centre_wanted_ = false;
    if (answer.what) centre_on(*answer.what);
  }
  if (drag_button_ < 0 && answer.what && answer.what->kind == PickKind::particle)
    describe(answer.what->index);
}

Status App::ask_what_is_under_mouse() {
  const bool free = drag_button_ < 0 || centre_wanted_;
  if (!free || simulation_->hand() || gui_->takes_mouse() || !shown_.contains(mouse_x_, mouse_y_)) {
    asked_.reset();
    centre_wanted_ = false;
    return {};
  }
  const bool known = asked_ && asked_->x == mouse_x_ && asked_->y == mouse_y_;
  if (known && asked_->picture == pictures_drawn_) return {};
  const auto number = renderer_->request_pick({mouse_x_ - shown_.left, mouse_y_ - shown_.top,
                                               shown_.right - shown_.left, shown_.bottom - shown_.top});
  if (!number) return number.error();
  asked_ = Question{mouse_x_, mouse_y_, pictures_drawn_, asked_ ? asked_->first : *number, *number};
  return {};
}

HighlightOptions App::marks(int width) const {
  HighlightOptions marks;
  if (const auto& hand = simulation_->hand()) marks.pull = {hand->particle, hand->anchor};
  for (const auto& [particle, pinned] : simulation_->setup().pinned)
    if (pinned) marks.marked.push_back(particle);
  marks.unit = gui_->scale() * width / std::max(viewport_.right - viewport_.left, 1.0);
  return marks;
}

/// Over the picture rather than in it: so it follows the mouse however long pictures take, and is in no film.
Status App::present_ring() {
  if (!hovered_) return {};
  HighlightOptions ring;
  ring.hovered = hovered_->particle;
  ring.unit = gui_->scale() * pixels_per_unit_;
  ring.pinned = false;
  const auto& [left, bottom, width, height] = shown_pixels_;
  return renderer_->present_highlight(ring, 0, width, height, left, bottom);
}

bool App::is_double_click() {
  const double time = clock_ ? clock_() : now();
  const bool twice = time - pressed_time_ <= double_click_time &&
                     std::hypot(mouse_x_ - pressed_x_, mouse_y_ - pressed_y_) <= double_click_reach;
  // A third press begins anew.
  pressed_time_ = twice ? -1e9 : time;
  pressed_x_ = mouse_x_;
  pressed_y_ = mouse_y_;
  if (twice) asked_.reset();  // what counts is what is there now
  return twice;
}

void App::centre_on(const Picked& picked) {
  const State& state = simulation_->snapshot();
  Vec3 point = picked.point;
  if (picked.kind == PickKind::particle) point = state.position[picked.index];
  if (picked.kind == PickKind::ball && picked.index < state.ball_position.size())
    point = state.ball_position[picked.index];
  camera_.centre(point);
}

}  // namespace aspic::app
