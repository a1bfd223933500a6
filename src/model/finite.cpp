// Numbers that no solver may get.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "base/result.h"
#include "model/counts.h"

namespace aspic {
namespace {

/// What every solver can hold, in single precision too.
bool fits(double x) {
  return std::abs(x) <= std::numeric_limits<float>::max();
}
bool fits(const Vec3& v) {
  return fits(v.x) && fits(v.y) && fits(v.z);
}

Error refused(std::string_view what) {
  return fail(ErrorCode::scene_rejected,
              "{} is not a finite number in single precision; with_overrides() checks what it sets", what);
}

/// Constants that belong to no particle.
Status check_constants(const Model& model) {
  const SimulationSettings& s = model.simulation;
  if (!(s.timestep > 0.0) || !fits(s.timestep)) return refused("simulation.timestep");
  if (!fits(s.gravity)) return refused("simulation.gravity");
  for (const auto& [constant, name] : resistance_constants)
    if (!(s.*constant >= 0.0) || !fits(s.*constant)) return refused(fmt::format("simulation.{}", name));
  if (!fits(s.duration)) return refused("simulation.duration");
  if (!fits(s.implicit.tolerance.value_or(0.0))) return refused("simulation.implicit.tolerance");
  const ContactSettings& c = model.contact;
  for (const double x : {c.distance, c.resting_speed, c.restitution, c.friction, c.ball_restitution,
                         c.ball_friction, c.body_friction, c.body_gap, c.body_damping})
    if (!fits(x)) return refused("a number of contact");
  for (std::size_t t = 0; t < model.terrain.size(); ++t) {
    const Terrain& terrain = model.terrain[t];
    bool good = !std::isnan(terrain.mass) && fits(terrain.restitution) && fits(terrain.friction);
    for (const Vec3& v : terrain.geometry.vectors) good = good && fits(v);
    for (const double x : terrain.geometry.numbers) good = good && fits(x);
    if (const auto& m = terrain.motion)
      good = good && fits(m->direction) && fits(m->amplitude) && fits(m->frequency) && fits(m->phase);
    if (!good) return refused(fmt::format("a number of terrain[{}]", t));
  }
  for (const SpringClass& spring : model.spring_classes)
    if (!fits(spring.stiffness) || !fits(spring.damping) || !fits(spring.rest_length))
      return refused("a spring's stiffness, damping or rest length");
  for (const Actuator& a : model.actuation.actuators) {
    bool good = fits(a.amplitude) && fits(a.frequency) && fits(a.start) && fits(a.ramp);
    for (const auto& [time, value] : a.table) good = good && fits(time) && fits(value);
    if (!good) return refused(fmt::format("a number of {}", a.name));
  }
  for (const Drive& drive : model.actuation.drives)
    if (!fits(drive.phase)) return refused("the phase of an actuator");
  return {};
}

}  // namespace

Status check_finite(const Model& model) {
  ASPIC_CHECK(check_constants(model));
  for (const Body& body : model.bodies)
    if (!fits(body.friction.value_or(0.0))) return refused("a body's friction");
  for (const auto* const list : {&model.mass, &model.inverse_mass})
    for (const auto& run : list->runs())
      if (!fits(run.value)) return refused("a particle's mass, or one over it,");
  for (const auto& run : model.initial_velocity.runs())
    if (!fits(run.value)) return refused("a particle's velocity");
  for (std::size_t i = 0; i < model.particle_count(); ++i)
    if (!fits(model.initial_position[i])) return refused(fmt::format("the position of particle {}", i));
  for (std::size_t b = 0; b < model.balls.size(); ++b) {
    const Ball& ball = model.balls[b];
    if (!fits(ball.radius) || !fits(ball.mass) || !fits(1.0 / ball.mass) || !fits(ball.initial_position) ||
        !fits(ball.initial_velocity) || !fits(ball.initial_angular_velocity))
      return refused(fmt::format("a number of ball {}", b));
  }
  return {};
}

}  // namespace aspic
