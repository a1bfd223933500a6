#include "app/hands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/inputs.h"
#include "model/integrator.h"

namespace aspic::app {

/// A ball that leaves the eye's lower edge along a sight line.
BallSettings Hands::thrown_ball(const Ray& sight) const {
  BallSettings ball;
  ball.radius = radius;
  ball.mass = mass;
  ball.position = sight.origin + (2.0 * radius) * sight.direction - radius * Vec3{0.0, 1.0, 0.0};
  ball.velocity = speed * sight.direction;
  return ball;
}

void Hands::throw_ball(const Ray& sight) {
  messages_.check(simulation_.rebuild().throw_balls({thrown_ball(sight)}));
}

void Hands::throw_many() {
  // A sunflower's seeds: spread evenly over the middle of the image, side by side where they start.
  constexpr int many = 12;
  constexpr double golden_angle = 2.399963229728653;
  const double width = view_.width(), height = view_.height();
  const Camera camera = view_.lens();
  const glm::mat4& to_view = camera.view();
  const Vec3 right = {to_view[0][0], to_view[1][0], to_view[2][0]};
  const Vec3 up = {to_view[0][1], to_view[1][1], to_view[2][1]};
  std::vector<BallSettings> balls;
  for (int i = 0; i < many; ++i) {
    const double angle = golden_angle * static_cast<double>(thrown_++);
    const double out = std::sqrt((i + 0.5) / many);
    const double dx = out * std::cos(angle), dy = out * std::sin(angle);
    BallSettings ball =
        thrown_ball(camera.ray_through((0.5 + 0.15 * dx) * width, (0.5 + 0.15 * dy) * height));
    const double spread = 1.4 * ball.radius * std::sqrt(static_cast<double>(many));
    ball.position = ball.position + (spread * dx) * right - (spread * dy) * up;
    balls.push_back(ball);
  }
  messages_.check(simulation_.rebuild().throw_balls(balls));
}

void Hands::clear_balls() {
  messages_.check(simulation_.rebuild().clear_balls());
}

/// True with a message if pulls and pins are not possible.
bool Hands::refused() {
  const auto why = refusal ? refusal() : std::nullopt;
  if (why) messages_.refuse(*why);
  return why.has_value();
}

void Hands::toggle_pin(std::uint32_t particle) {
  if (refused()) return;
  const bool pinned = inverse_mass_of(simulation_.model(), simulation_.inputs(), particle) == 0.0;
  if (messages_.check(simulation_.rebuild().toggle_pin(particle)))
    messages_.info(fmt::format("Particle {} is {}.", particle, pinned ? "free" : "pinned"));
}

/// With its damping, and what an explicit method can handle of a pull on that mass: k·h²/m is at most `most`.
void Hands::take_hold(Pull pull, double held_mass, double most) {
  const SimulationSettings& s = simulation_.model().simulation;
  const double h = s.timestep;
  const bool cautious = pull.ball || !row_of(s.integrator).traits.stable_at_any_step;
  if (cautious) pull.stiffness = std::min(pull.stiffness, most * held_mass / (h * h));
  pull.damping = 2.0 * std::sqrt(pull.stiffness * held_mass);
  if (cautious) pull.damping = std::min(pull.damping, 0.1 * held_mass / h);
  pull_plane_ = pull.anchor;
  simulation_.set_hand(pull);
}

/// Stiff against the springs of the body. A pull damps along its own direction alone; across it a particle
/// swings freely, and explicit Euler lets a swing grow at the rate h·k/2m, 5 a second at the cap on k, which
/// the body's own dampers hold down.
void Hands::begin_pull(std::uint32_t particle, const Vec3& position) {
  if (refused()) return;
  const Model& model = simulation_.model();
  double stiffest = 0.0;
  for (const SpringClass& c : model.spring_classes) stiffest = std::max(stiffest, c.stiffness);
  const double m = model.mass[particle];
  take_hold({particle, position, 2.0 * strength * (stiffest > 0.0 ? stiffest : 100.0 * m), 0.0}, m, 0.01);
}

/// A ball sags by g·m/k, 5 cm, and swings with a period of 0.45 s. Nothing but the pull holds a swing down,
/// and all methods let it grow at a rate of up to h·k/2m.
void Hands::begin_ball_pull(std::uint32_t ball, const Vec3& position) {
  const double m = simulation_.model().balls[ball].mass;
  take_hold({ball, position, 200.0 * strength * m, 0.0, true}, m, 0.001);
}

void Hands::move_pull(double x, double y) {
  if (!simulation_.hand()) return;
  const Camera camera = view_.lens();
  const Ray axis = camera.ray_through(0.5 * view_.width(), 0.5 * view_.height());
  const Ray sight = camera.ray_through(x, y);
  const double along = dot(sight.direction, axis.direction);
  if (!(along > 1e-3)) return;
  Pull pull = *simulation_.hand();
  pull.anchor = sight.origin + (dot(pull_plane_ - sight.origin, axis.direction) / along) * sight.direction;
  simulation_.set_hand(pull);
}

}  // namespace aspic::app
