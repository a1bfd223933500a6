#include "analysis/particle_force.h"

#include <algorithm>
#include <cassert>

#include "analysis/body_contact_forces.h"
#include "analysis/contact_force.h"
#include "model/counts.h"
#include "model/inputs.h"
#include "model/springs.h"
#include "physics/body_force.h"
#include "physics/pulls/law.h"

namespace aspic {
namespace {

std::vector<Spring> of_lattice(const Body& body, std::uint32_t particle) {
  const Lattice& box = *body.box();
  const Lattice::Place own = box.place(particle - body.first_particle);
  std::vector<Spring> found;
  for (const LatticeDirection& o : lattice_directions()) {
    const Lattice::Place other = {own[0] + o.di, own[1] + o.dj, own[2] + o.dk};
    if (!box.contains(other)) continue;
    const std::uint32_t index = body.first_particle + box.index(other);
    found.push_back(
        {std::min(particle, index), std::max(particle, index), body.first_class + o.spring_class});
  }
  return found;
}

using Vector = physics::Vector<double>;

Vector exact(const Vec3& v) {
  return physics::rounded<double>(v);
}

/// Gravity and resistance on a particle or ball; returns their sum.
Vector add_body_force(const Model& model, double mass, const Vector& v, ParticleForce& force) {
  const physics::BodyForce<double> of(model);
  force.gravity = physics::vec3_of(mass * of.gravity);
  force.drag = physics::vec3_of(-of.resistance(mass, v));
  return of.at(mass, v);
}

/// Adds the pulls on a particle or ball to `net`.
void add_pulls(const Inputs& inputs, bool ball, std::uint32_t index, const Vector& x, const Vector& v,
               ParticleForce& force, Vector& net) {
  Vector sum = Vector::Zero();
  for (const Pull& pull : inputs.pulls) {
    if (pull.ball != ball || pull.particle != index) continue;
    const Vector f = physics::pull_force<double>(physics::PullConstants<double>(pull), x, v);
    sum += f;
    net += f;
  }
  force.pull = physics::vec3_of(sum);
}

}  // namespace

SpringFinder::SpringFinder(const Model& model) {
  for (const Spring& spring : model.listed_springs) widest_ = std::max(widest_, spring.b - spring.a);
}

std::vector<Spring> SpringFinder::of(const Model& model, std::uint32_t particle) const {
  const auto body = std::ranges::find_if(
      model.bodies, [&](const Body& b) { return particle - b.first_particle < b.particle_count; });
  if (body != model.bodies.end() && body->box()) return of_lattice(*body, particle);
  std::vector<Spring> found;
  const std::uint32_t first_end = particle - std::min(particle, widest_);
  const auto first = std::ranges::lower_bound(model.listed_springs, first_end, {}, &Spring::a);
  for (auto s = first; s != model.listed_springs.end() && s->a <= particle; ++s)
    if (s->a == particle || s->b == particle) found.push_back(*s);
  return found;
}

ParticleForce particle_force(const Model& model, const SpringFinder& springs, const State& state,
                             std::uint32_t particle, const Inputs& inputs, const BodyContactForces* bodies) {
  assert(check_sizes(model, state) && particle < model.particle_count());
  const Vector x = exact(state.position[particle]), v = exact(state.velocity[particle]);
  ParticleForce force;
  Vector net = add_body_force(model, model.mass[particle], v, force), sum = Vector::Zero();
  const auto classes = physics::classes_at<double>(model, state.step, 0.0, inputs.channels);
  for (const Spring& spring : springs.of(model, particle)) {
    const std::uint32_t other = spring.a == particle ? spring.b : spring.a;
    const Vector f = physics::spring_force<double>(
        classes[spring.spring_class], x - exact(state.position[other]), v - exact(state.velocity[other]));
    sum += f;
    net += f;
  }
  force.springs = physics::vec3_of(sum);
  add_pulls(inputs, false, particle, x, v, force, net);
  if (bodies) {
    force.bodies = bodies->on(particle);
    net += exact(force.bodies);
  }
  force.without_terrain = physics::vec3_of(net);
  const double w = inverse_mass_of(model, inputs, particle);
  force.applied = physics::vec3_of(net);
  if (w == 0.0) {
    force.pin = -1.0 * force.applied;
    return force;
  }
  const Vector before = net;
  const physics::ContactConstants<double> constants(model);
  for (const Terrain& terrain : model.terrain) {
    physics::Ground<double> ground(terrain);
    ground.begin_step(model.simulation.timestep, state.step);
    net = with_contact(model, constants, ground, w, x, v, net);
  }
  force.contact = physics::vec3_of(net - before);
  force.net = physics::vec3_of(net);
  if (model.contact.model == ContactModel::course) force.applied = force.net;
  return force;
}

ParticleForce ball_force(const Model& model, const State& state, std::uint32_t ball, const Inputs& inputs) {
  assert(check_sizes(model, state) && ball < model.ball_count());
  const Vector x = exact(state.ball_position[ball]), v = exact(state.ball_velocity[ball]);
  ParticleForce force;
  Vector net = add_body_force(model, model.balls[ball].mass, v, force);
  add_pulls(inputs, true, ball, x, v, force, net);
  force.net = force.applied = force.without_terrain = physics::vec3_of(net);
  return force;
}

Vec3 external_force(const ParticleForce& force) {
  Vec3 sum;
  for (const ForceRow& row : force_rows)
    if (row.external) sum = sum + force.*row.force;
  return sum;
}

}  // namespace aspic
