#include "device/particles.h"

#include <algorithm>
#include <cassert>
#include <type_traits>

#include "model/reading.h"

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

namespace {

void set_weights(const Model& model, std::span<layout::Particle> particles) {
  fill(particles, &layout::Particle::position, model.inverse_mass);
  fill(particles, &layout::Particle::velocity, model.mass);
}

/// What balls have besides position, velocity and spin.
void set_constants(const Model& model, std::span<layout::Ball> balls, std::uint64_t step) {
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    const double inertia = ball.inertia();
    balls[b].start_velocity = balls[b].velocity;
    balls[b].position.w = static_cast<float>(ball.radius);
    balls[b].velocity.w = static_cast<float>(ball.launched(step) ? 1.0 / ball.mass : 0.0);
    balls[b].spin.w = static_cast<float>(ball.radius / inertia);
    balls[b].start_velocity.w = static_cast<float>(ball.radius * ball.radius / inertia);
  }
}

StateView places_in(std::span<layout::Particle> particles, std::span<layout::Ball> balls) {
  StateView view;
  view[position] = vectors_in(particles, &layout::Particle::position);
  view[velocity] = vectors_in(particles, &layout::Particle::velocity);
  view[ball_position] = vectors_in(balls, &layout::Ball::position);
  view[ball_velocity] = vectors_in(balls, &layout::Ball::velocity);
  view[ball_spin] = vectors_in(balls, &layout::Ball::spin);
  return view;
}

}  // namespace

std::vector<layout::Particle> packed_particles(const Model& model, const ConstStateView& state) {
  assert(count_of(state[position]) == model.particle_count());
  assert(count_of(state[velocity]) == model.particle_count());
  std::vector<layout::Particle> particles(model.particle_count());
  const StateView places = places_in(particles, {});
  for (const std::size_t field : {position, velocity}) copy_vectors(state[field], places[field]);
  set_weights(model, particles);
  return particles;
}

std::vector<layout::Ball> packed_balls(const Model& model, const ConstStateView& state, std::uint64_t step) {
  assert(model.ball_count() == 0 || count_of(state[ball_position]) == model.ball_count());
  std::vector<layout::Ball> balls(model.ball_count());
  const StateView places = places_in({}, balls);
  for (const std::size_t field : {ball_position, ball_velocity, ball_spin})
    copy_vectors(state[field], places[field]);
  set_constants(model, balls, step);
  return balls;
}

Result<std::uint64_t> read_packed(Solver& solver, std::span<layout::Particle> particles,
                                  std::span<layout::Ball> balls) {
  ASPIC_TRY(const std::uint64_t step, solver.read_into(places_in(particles, balls)));
  set_weights(solver.model(), particles);
  set_constants(solver.model(), balls, step);
  return step;
}

void unpack(std::span<const layout::Particle> particles, const StateView& view, std::size_t first) {
  // Both fields of some particles, before these leave the first-level cache.
  constexpr std::size_t block = 256;
  for (std::size_t at = 0; at < particles.size(); at += block) {
    const auto some = particles.subspan(at, std::min(block, particles.size() - at));
    copy_vectors(vectors_in(some, &layout::Particle::position),
                 part_of(view[position], first + at, some.size()));
    copy_vectors(vectors_in(some, &layout::Particle::velocity),
                 part_of(view[velocity], first + at, some.size()));
  }
}

void unpack(std::span<const layout::Ball> balls, const StateView& view) {
  copy_vectors(vectors_in(balls, &layout::Ball::position), view[ball_position]);
  copy_vectors(vectors_in(balls, &layout::Ball::velocity), view[ball_velocity]);
  copy_vectors(vectors_in(balls, &layout::Ball::spin), view[ball_spin]);
}

}  // namespace aspic
