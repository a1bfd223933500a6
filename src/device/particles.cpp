#include "device/particles.h"

#include <cassert>

namespace aspic {
namespace {

Vec3 unpacked(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

layout::vec4 rounded(const Vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

layout::SpringClass rounded(const SpringClass& spring) {
  return {static_cast<float>(spring.stiffness), static_cast<float>(spring.damping),
          static_cast<float>(spring.rest_length), spring.cord ? 1u : 0u};
}

std::vector<layout::Particle> packed_particles(const Model& model, const State& state) {
  assert(state.position.size() == model.particle_count() && state.velocity.size() == model.particle_count());
  std::vector<layout::Particle> particles(state.position.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    particles[i] = {rounded(state.position[i], model.inverse_mass[i]),
                    rounded(state.velocity[i], model.mass[i])};
  }
  return particles;
}

std::vector<layout::Ball> packed_balls(const Model& model, const State& state) {
  assert(state.ball_position.size() == model.ball_count());
  std::vector<layout::Ball> balls(model.ball_count());
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    const double inertia = ball.inertia(), w = ball.launched(state.step) ? 1.0 / ball.mass : 0.0;
    balls[b] = {rounded(state.ball_position[b], ball.radius), rounded(state.ball_velocity[b], w),
                rounded(state.ball_angular_velocity[b], ball.radius / inertia),
                rounded(state.ball_velocity[b], ball.radius * ball.radius / inertia)};
  }
  return balls;
}

void unpack(std::span<const layout::Particle> particles, State& state) {
  state.position.reserve(particles.size());
  state.velocity.reserve(particles.size());
  for (const layout::Particle& p : particles) {
    state.position.push_back(unpacked(p.position));
    state.velocity.push_back(unpacked(p.velocity));
  }
}

void unpack(std::span<const layout::Ball> balls, State& state) {
  for (const layout::Ball& ball : balls) {
    state.ball_position.push_back(unpacked(ball.position));
    state.ball_velocity.push_back(unpacked(ball.velocity));
    state.ball_angular_velocity.push_back(unpacked(ball.spin));
  }
}

}  // namespace aspic
