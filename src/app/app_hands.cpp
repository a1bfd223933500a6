// The part of App that travels in time, throws, pulls and pins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/app.h"
#include "model/integrator.h"

namespace aspic::app {
namespace {

constexpr double jump = 0.5;  // s
constexpr int many = 12;

}  // namespace

// ---- time ----

/// Of the scene the physics is part of the run, so it goes back and forth with it: as a change that can be
/// undone.
void App::follow_history() {
  Scene scene = editor_.scene();
  scene.model = simulation_->setup().settings;
  if (effect_between(editor_.scene(), scene) < Effect::constants) return;
  pending_ = Effect::none;
  if (const auto applied = editor_.apply(std::move(scene), "going back in time", ""); !applied)
    tell(applied.error());
}

void App::step_back() {
  if (!simulation_->can_step_back()) return;
  stable_.reset();
  tell(simulation_->step_back());
  follow_history();
}

void App::jump_back() {
  go_to(simulation_->time() - jump);
}

void App::go_to(double time) {
  stable_.reset();
  tell(simulation_->seek(simulation_->history().nearest(time)));
  follow_history();
}

void App::back_before_trouble() {
  stable_.reset();
  dismiss_notice();
  tell(simulation_->seek(simulation_->before_trouble()));
  follow_history();
}

void App::take_stable_step() {
  if (!stable_ || !stable_->step || !std::isfinite(*stable_->step)) return;
  // Two digits below: an estimate is not trusted to its last one.
  const double limit = 0.95 * *stable_->step;
  const double unit = std::pow(10.0, std::floor(std::log10(limit)) - 1.0);
  const double step = std::floor(limit / unit) * unit;
  back_before_trouble();
  set_value(*find_parameter("simulation.timestep"), 0, Value(step), "");
}

void App::toggle_shadow() {
  const bool on = !simulation_->shadowed();
  const Status changed = simulation_->set_shadow(on);
  if (!changed) return tell(changed);
  tell(on ? fmt::format("Shadowed by {}.", simulation_->shadow()->description()) : "Shadow mode is off.");
}

// ---- hands ----

Camera App::view_camera() const {
  return {camera_.shown(), std::max(static_cast<int>(viewport_.right - viewport_.left), 1),
          std::max(static_cast<int>(viewport_.bottom - viewport_.top), 1)};
}

/// A ball that leaves the eye's lower edge for the place (x, y) of the picture.
BallSettings App::thrown_ball(double x, double y) const {
  const Ray sight = view_camera().ray_through(x, y);
  const Vec3 up = {0.0, 1.0, 0.0};
  BallSettings ball;
  ball.radius = hands_.radius;
  ball.mass = hands_.mass;
  ball.position = sight.origin + (2.0 * ball.radius) * sight.direction - ball.radius * up;
  ball.velocity = hands_.speed * sight.direction;
  return ball;
}

void App::throw_ball() {
  const bool aims = viewport_.contains(mouse_x_, mouse_y_) && !gui_->takes_mouse();
  const double x = aims ? mouse_x_ - viewport_.left : 0.5 * (viewport_.right - viewport_.left);
  const double y = aims ? mouse_y_ - viewport_.top : 0.5 * (viewport_.bottom - viewport_.top);
  still_ = 0.0;
  tell(simulation_->throw_balls({thrown_ball(x, y)}));
}

void App::throw_many() {
  const double width = viewport_.right - viewport_.left, height = viewport_.bottom - viewport_.top;
  std::vector<BallSettings> balls;
  // A sunflower's seeds: spread evenly over the middle of the picture, side by side where they start.
  constexpr double golden_angle = 2.399963229728653;
  const Camera camera = view_camera();
  const Ray axis = camera.ray_through(0.5 * width, 0.5 * height);
  const Vec3 right = camera.ray_through(width, 0.5 * height).direction - axis.direction;
  const Vec3 up = camera.ray_through(0.5 * width, 0.0).direction - axis.direction;
  for (int i = 0; i < many; ++i) {
    const double angle = golden_angle * static_cast<double>(thrown_++);
    const double out = std::sqrt((i + 0.5) / many);
    const double dx = out * std::cos(angle), dy = out * std::sin(angle);
    BallSettings ball = thrown_ball((0.5 + 0.15 * dx) * width, (0.5 + 0.15 * dy) * height);
    const double spread = 1.4 * ball.radius * std::sqrt(static_cast<double>(many));
    ball.position = ball.position + (spread * dx / length(right)) * right - (spread * dy / length(up)) * up;
    balls.push_back(ball);
  }
  still_ = 0.0;
  tell(simulation_->throw_balls(balls));
}

void App::clear_balls() {
  still_ = 0.0;
  tell(simulation_->clear_balls());
}

void App::toggle_pin(std::uint32_t particle) {
  const bool pinned = simulation_->model().inverse_mass[particle] == 0.0;
  still_ = 0.0;
  const Status changed = simulation_->toggle_pin(particle);
  if (!changed) return tell(changed);
  tell(fmt::format("Particle {} is {}.", particle, pinned ? "free" : "pinned"));
}

/// Stiff against the springs of the body. A pull damps along its own direction alone; across it a particle
/// swings freely, and explicit Euler lets a swing grow at the rate h·k/2m, 5 a second at the cap on k, which
/// the body's own dampers hold down.
void App::begin_pull() {
  const Model& model = simulation_->model();
  const std::uint32_t particle = hovered_->particle;
  double stiffest = 0.0;
  for (const SpringClass& c : model.spring_classes) stiffest = std::max(stiffest, c.stiffness);
  const double m = model.mass[particle], h = model.simulation.timestep;
  Pull pull;
  pull.particle = particle;
  pull.anchor = pull_plane_ = hovered_->position;
  pull.stiffness = 2.0 * hands_.strength * (stiffest > 0.0 ? stiffest : 100.0 * m);
  const bool explicit_method = !row_of(model.simulation.integrator).solved();
  if (explicit_method) pull.stiffness = std::min(pull.stiffness, 0.01 * m / (h * h));
  pull.damping = 2.0 * std::sqrt(pull.stiffness * m);
  if (explicit_method) pull.damping = std::min(pull.damping, 0.1 * m / h);
  simulation_->set_hand(pull);
}

void App::move_pull() {
  if (!simulation_->hand()) return;
  const double width = viewport_.right - viewport_.left, height = viewport_.bottom - viewport_.top;
  const Camera camera = view_camera();
  const Ray axis = camera.ray_through(0.5 * width, 0.5 * height);
  const Ray sight = camera.ray_through(mouse_x_ - viewport_.left, mouse_y_ - viewport_.top);
  const double along = dot(sight.direction, axis.direction);
  if (!(along > 1e-3)) return;
  Pull pull = *simulation_->hand();
  pull.anchor = sight.origin + (dot(pull_plane_ - sight.origin, axis.direction) / along) * sight.direction;
  simulation_->set_hand(pull);
}

void App::end_pull() {
  simulation_->set_hand(std::nullopt);
}

}  // namespace aspic::app
