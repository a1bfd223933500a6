#include "device/particles.h"

#include <cassert>

namespace aspic {
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

namespace {

/// The vectors that a member of every item begins with.
template <class Item>
ConstVectors vectors_in(std::span<const Item> items, layout::vec4 Item::*member) {
  static_assert(sizeof(Item) % sizeof(float) == 0);
  if (items.empty()) return Strided<const float>{};
  return Strided<const float>{&(items.front().*member).x, items.size(), sizeof(Item) / sizeof(float)};
}

}  // namespace

void unpack(std::span<const layout::Particle> particles, const StateView& view) {
  copy_vectors(vectors_in(particles, &layout::Particle::position), view[field_number("position")]);
  copy_vectors(vectors_in(particles, &layout::Particle::velocity), view[field_number("velocity")]);
}

void unpack(std::span<const layout::Ball> balls, const StateView& view) {
  copy_vectors(vectors_in(balls, &layout::Ball::position), view[field_number("ball_position")]);
  copy_vectors(vectors_in(balls, &layout::Ball::velocity), view[field_number("ball_velocity")]);
  copy_vectors(vectors_in(balls, &layout::Ball::spin), view[field_number("ball_angular_velocity")]);
}

}  // namespace aspic
