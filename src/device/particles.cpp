#include "device/particles.h"

#include <cassert>
#include <type_traits>

namespace aspic {
layout::vec4 rounded(const Vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

layout::SpringClass rounded(const SpringClass& spring) {
  return {static_cast<float>(spring.stiffness), static_cast<float>(spring.damping),
          static_cast<float>(spring.rest_length), spring.cord ? 1u : 0u};
}

namespace {

/// The vectors that a member of every item begins with.
template <class Item>
auto vectors_in(std::span<Item> items, layout::vec4 std::remove_const_t<Item>::*member) {
  using Number = std::conditional_t<std::is_const_v<Item>, const float, float>;
  static_assert(sizeof(Item) % sizeof(float) == 0);
  if (items.empty()) return Strided<Number>{};
  return Strided<Number>{&(items.front().*member).x, items.size(), sizeof(Item) / sizeof(float)};
}

/// Gives a member of every item a number for each particle.
void fill(std::span<layout::Particle> items, layout::vec4 layout::Particle::*member,
          const Runs<double>& from) {
  std::size_t first = 0;
  for (const auto& [end, value] : from.runs()) {
    for (; first < end; ++first) (items[first].*member).w = static_cast<float>(value);
  }
}

constexpr std::size_t position = field_number("position"), velocity = field_number("velocity"),
                      ball_position = field_number("ball_position"),
                      ball_velocity = field_number("ball_velocity"),
                      ball_spin = field_number("ball_angular_velocity");

}  // namespace

std::vector<layout::Particle> packed_particles(const Model& model, const ConstStateView& state) {
  assert(count_of(state[position]) == model.particle_count());
  assert(count_of(state[velocity]) == model.particle_count());
  std::vector<layout::Particle> particles(model.particle_count());
  copy_vectors(state[position], vectors_in(std::span(particles), &layout::Particle::position));
  copy_vectors(state[velocity], vectors_in(std::span(particles), &layout::Particle::velocity));
  fill(particles, &layout::Particle::position, model.inverse_mass);
  fill(particles, &layout::Particle::velocity, model.mass);
  return particles;
}

std::vector<layout::Ball> packed_balls(const Model& model, const ConstStateView& state, std::uint64_t step) {
  assert(model.ball_count() == 0 || count_of(state[ball_position]) == model.ball_count());
  std::vector<layout::Ball> balls(model.ball_count());
  const std::span all(balls);
  copy_vectors(state[ball_position], vectors_in(all, &layout::Ball::position));
  copy_vectors(state[ball_velocity], vectors_in(all, &layout::Ball::velocity));
  copy_vectors(state[ball_spin], vectors_in(all, &layout::Ball::spin));
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    const double inertia = ball.inertia();
    balls[b].start_velocity = balls[b].velocity;
    balls[b].position.w = static_cast<float>(ball.radius);
    balls[b].velocity.w = static_cast<float>(ball.launched(step) ? 1.0 / ball.mass : 0.0);
    balls[b].spin.w = static_cast<float>(ball.radius / inertia);
    balls[b].start_velocity.w = static_cast<float>(ball.radius * ball.radius / inertia);
  }
  return balls;
}

void unpack(std::span<const layout::Particle> particles, const StateView& view) {
  copy_vectors(vectors_in(particles, &layout::Particle::position), view[position]);
  copy_vectors(vectors_in(particles, &layout::Particle::velocity), view[velocity]);
}

void unpack(std::span<const layout::Ball> balls, const StateView& view) {
  copy_vectors(vectors_in(balls, &layout::Ball::position), view[ball_position]);
  copy_vectors(vectors_in(balls, &layout::Ball::velocity), view[ball_velocity]);
  copy_vectors(vectors_in(balls, &layout::Ball::spin), view[ball_spin]);
}

}  // namespace aspic
