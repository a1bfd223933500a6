#include "analysis/particle_force.h"

#include <algorithm>
#include <cassert>

#include "cpu_reference/contact.h"
#include "cpu_reference/spring.h"

namespace aspic {
SpringFinder::SpringFinder(const Model& model) {
  for (const Spring& spring : model.springs) widest_ = std::max(widest_, spring.b - spring.a);
}

std::vector<std::uint32_t> SpringFinder::of(const Model& model, std::uint32_t particle) const {
  const std::uint32_t first_end = particle - std::min(particle, widest_);
  const auto first = std::ranges::lower_bound(model.springs, first_end, {}, &Spring::a);
  std::vector<std::uint32_t> found;
  for (auto s = first; s != model.springs.end() && s->a <= particle; ++s)
    if (s->a == particle || s->b == particle)
      found.push_back(static_cast<std::uint32_t>(s - model.springs.begin()));
  return found;
}

ParticleForce particle_force(const Model& model, const SpringFinder& springs, const State& state,
                             std::uint32_t particle, const std::optional<Pull>& pull) {
  using Vector = reference::Vector<double>;
  assert(check_sizes(model, state) && particle < model.particle_count());
  const auto exact = [](const Vec3& v) { return reference::rounded<double>(v); };
  const auto back = [](const Vector& v) { return Vec3{v.x(), v.y(), v.z()}; };
  const Vector x = exact(state.position[particle]), v = exact(state.velocity[particle]);
  ParticleForce force;
  force.gravity = model.mass[particle] * model.simulation.gravity;
  Vector net = exact(force.gravity), sum = Vector::Zero();
  const auto pulled = [&](const SpringClass& spring, const Vec3& other_x, const Vec3& other_v) -> Vector {
    return reference::spring_force<double>(reference::SpringConstants<double>(spring), x, v, exact(other_x),
                                           exact(other_v));
  };
  for (const std::uint32_t index : springs.of(model, particle)) {
    const Spring& spring = model.springs[index];
    const std::uint32_t other = spring.a == particle ? spring.b : spring.a;
    const Vector f =
        pulled(model.spring_classes[spring.spring_class], state.position[other], state.velocity[other]);
    sum += f;
    net += f;
  }
  force.springs = back(sum);
  if (pull && pull->particle == particle) {
    const Vector f =
        pulled({SpringType::structural, pull->stiffness, pull->damping, 0.0, false}, pull->anchor, {});
    force.pull = back(f);
    net += f;
  }
  const Vector before = net;
  if (model.contact.model == ContactModel::course && model.inverse_mass[particle] != 0.0) {
    for (const Terrain& terrain : model.terrain) {
      reference::Ground<double> ground(terrain);
      ground.begin_step(model.simulation.timestep, state.step);
      net = reference::with_contact_force<double>(ground, model.contact.epsilon, x, v, net);
    }
  }
  force.contact = back(net - before);
  force.net = back(net);
  return force;
}

}  // namespace aspic
