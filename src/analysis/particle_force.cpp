#include "analysis/particle_force.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <ranges>

#include "model/springs.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// Force of a spring on its end at xa.
Vec3 spring_force(const SpringClass& spring, const Vec3& xa, const Vec3& va, const Vec3& xb, const Vec3& vb) {
  const Vec3 e = xa - xb;
  const double length_now = length(e);
  if (length_now == 0.0 || (spring.cord && length_now < spring.rest_length)) return {};
  const double q = 1.0 / length_now;
  const double s =
      spring.stiffness * (length_now - spring.rest_length) + spring.damping * (dot(va - vb, e) * q);
  return -(s * q) * e;
}

/// What is left of f after the course model's contact with one terrain.
Vec3 after_contact(const Terrain& terrain, double epsilon, const Vec3& x, const Vec3& v, const Vec3& f) {
  const auto [d, n] = terrain_gap(terrain, x);
  const double u = dot(v, n), along = dot(f, n);
  if (!(d < epsilon && std::abs(u) < epsilon && along < 0.0)) return f;
  const Vec3 slip = v - u * n;
  return (f - along * n) + (terrain.friction * along) * slip;
}

std::vector<Spring> of_lattice(const Body& body, std::uint32_t particle) {
  const auto n = static_cast<int>(body.lattice_edge);
  const auto local = static_cast<int>(particle - body.first_particle);
  const std::array<int, 3> own = {local / (n * n), local / n % n, local % n};
  std::vector<Spring> found;
  const auto add = [&](const LatticeDirection& o, int sign) {
    const std::array<int, 3> other = {own[0] + sign * o.di, own[1] + sign * o.dj, own[2] + sign * o.dk};
    if (std::ranges::any_of(other, [&](int at) { return at < 0 || at >= n; })) return;
    const auto index =
        body.first_particle + static_cast<std::uint32_t>((other[0] * n + other[1]) * n + other[2]);
    found.push_back(
        {std::min(particle, index), std::max(particle, index), body.first_class + o.spring_class});
  };
  for (const LatticeDirection& o : std::views::reverse(lattice_directions())) add(o, -1);
  for (const LatticeDirection& o : lattice_directions()) add(o, 1);
  return found;
}

}  // namespace

SpringFinder::SpringFinder(const Model& model) {
  for (const Spring& spring : model.listed_springs) widest_ = std::max(widest_, spring.b - spring.a);
}

std::vector<Spring> SpringFinder::of(const Model& model, std::uint32_t particle) const {
  const auto body = std::ranges::find_if(
      model.bodies, [&](const Body& b) { return particle - b.first_particle < b.particle_count; });
  if (body != model.bodies.end() && body->lattice_edge > 0) return of_lattice(*body, particle);
  std::vector<Spring> found;
  const std::uint32_t first_end = particle - std::min(particle, widest_);
  const auto first = std::ranges::lower_bound(model.listed_springs, first_end, {}, &Spring::a);
  for (auto s = first; s != model.listed_springs.end() && s->a <= particle; ++s)
    if (s->a == particle || s->b == particle) found.push_back(*s);
  return found;
}

ParticleForce particle_force(const Model& model, const SpringFinder& springs, const State& state,
                             std::uint32_t particle, const std::optional<Pull>& pull) {
  assert(check_sizes(model, state) && particle < model.particle_count());
  const Vec3 &x = state.position[particle], &v = state.velocity[particle];
  ParticleForce force;
  force.gravity = force.net = model.mass[particle] * model.simulation.gravity;
  for (const Spring& spring : springs.of(model, particle)) {
    const std::uint32_t other = spring.a == particle ? spring.b : spring.a;
    const Vec3 f = spring_force(model.spring_classes[spring.spring_class], x, v, state.position[other],
                                state.velocity[other]);
    force.springs = force.springs + f;
    force.net = force.net + f;
  }
  if (pull && pull->particle == particle) {
    const SpringClass band = {SpringType::structural, pull->stiffness, pull->damping, 0.0, false};
    force.pull = spring_force(band, x, v, pull->anchor, {});
    force.net = force.net + force.pull;
  }
  if (model.contact.model != ContactModel::course || model.inverse_mass[particle] == 0.0) return force;
  const Vec3 before = force.net;
  const double h = model.simulation.timestep;
  for (const Terrain& terrain : model.terrain) {
    const Vec3 V = terrain.motion ? pose_at(*terrain.motion, h, state.step).velocity : Vec3{};
    force.net = after_contact(terrain_at(terrain, h, state.step), model.contact.epsilon, x, v - V, force.net);
  }
  force.contact = force.net - before;
  return force;
}

}  // namespace aspic
