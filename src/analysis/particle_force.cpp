#include "analysis/particle_force.h"

#include <algorithm>
#include <cassert>

#include "analysis/body_contact_forces.h"
#include "analysis/contact_force.h"
#include "model/counts.h"
#include "model/inputs.h"
#include "model/springs.h"
#include "physics/body_force.h"
#include "physics/springs/law.h"

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

SpringClass spring_of(const Pull& pull) {
  return {SpringType::structural, pull.stiffness, pull.damping, 0.0, false};
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
  using Vector = physics::Vector<double>;
  assert(check_sizes(model, state) && particle < model.particle_count());
  const auto exact = [](const Vec3& v) { return physics::rounded<double>(v); };
  const auto back = [](const Vector& v) { return Vec3{v.x(), v.y(), v.z()}; };
  const Vector x = exact(state.position[particle]), v = exact(state.velocity[particle]);
  ParticleForce force;
  force.gravity = model.mass[particle] * model.simulation.gravity;
  const Vector body = physics::BodyForce<double>(model).at(model.mass[particle], v);
  force.drag = back(body) - force.gravity;
  Vector net = body, sum = Vector::Zero();
  const std::vector<double> lengths = rest_lengths(model, state.step, 0.0, inputs.channels);
  const auto pulled = [&](const SpringClass& spring, const Vec3& other_x, const Vec3& other_v) -> Vector {
    return physics::spring_force<double>(physics::SpringConstants<double>(spring), x, v, exact(other_x),
                                         exact(other_v));
  };
  for (const Spring& spring : springs.of(model, particle)) {
    const std::uint32_t other = spring.a == particle ? spring.b : spring.a;
    SpringClass now = model.spring_classes[spring.spring_class];
    now.rest_length = lengths[spring.spring_class];
    const Vector f = pulled(now, state.position[other], state.velocity[other]);
    sum += f;
    net += f;
  }
  force.springs = back(sum);
  Vector pulls = Vector::Zero();
  for (const Pull& pull : inputs.pulls) {
    if (pull.ball || pull.particle != particle) continue;
    const Vector f = pulled(spring_of(pull), pull.anchor, {});
    pulls += f;
    net += f;
  }
  force.pull = back(pulls);
  if (bodies) {
    force.bodies = bodies->on(particle);
    net += exact(force.bodies);
  }
  const double w = inverse_mass_of(model, inputs, particle);
  force.applied = back(net);
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
  force.contact = back(net - before);
  force.net = back(net);
  if (model.contact.model == ContactModel::course) force.applied = force.net;
  return force;
}

ParticleForce ball_force(const Model& model, const State& state, std::uint32_t ball, const Inputs& inputs) {
  assert(check_sizes(model, state) && ball < model.ball_count());
  ParticleForce force;
  force.gravity = model.balls[ball].mass * model.simulation.gravity;
  force.drag = (-model.simulation.drag * model.balls[ball].mass) * state.ball_velocity[ball];
  for (const Pull& pull : inputs.pulls) {
    if (!pull.ball || pull.particle != ball) continue;
    const auto exact = [](const Vec3& v) { return physics::rounded<double>(v); };
    const physics::Vector<double> f = physics::spring_force<double>(
        physics::SpringConstants<double>(spring_of(pull)), exact(state.ball_position[ball]),
        exact(state.ball_velocity[ball]), exact(pull.anchor), exact({}));
    force.pull = force.pull + Vec3{f.x(), f.y(), f.z()};
  }
  force.net = force.applied = force.gravity + force.drag + force.pull;
  return force;
}

}  // namespace aspic
