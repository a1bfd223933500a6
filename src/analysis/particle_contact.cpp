#include "analysis/particle_contact.h"

#include <cassert>

#include "cpu_reference/coulomb.h"

namespace aspic {
namespace {

using reference::Ground;
using Vector = reference::Vector<double>;

/// The force f [N] on a particle at (x, v) with what a terrain adds to it.
Vector with_contact(const Model& model, const reference::ContactConstants<double>& constants,
                    const Ground<double>& ground, double inverse_mass, const Vector& x, const Vector& v,
                    const Vector& f) {
  if (model.contact.model == ContactModel::course)
    return reference::with_contact_force<double>(ground, constants.epsilon, x, v, f);
  const auto at = reference::gap<double>(ground, ground.start, x);
  if (!reference::rests<double>(constants, at.d, reference::dot3<double>(ground.start.relative(v), at.n)))
    return f;
  return reference::with_reaction<double>(ground.friction, at.n,
                                          reference::least_normal_speed<double>(constants, at.d),
                                          constants.step * inverse_mass, ground.end.relative(v), f);
}

}  // namespace

std::vector<ParticleContact> contacts_of(const Model& model, const SpringFinder& springs, const State& state,
                                         const std::optional<Pull>& pull) {
  assert(check_sizes(model, state));
  const reference::ContactConstants<double> constants(model);
  std::vector<Ground<double>> grounds(model.terrain.begin(), model.terrain.end());
  for (Ground<double>& ground : grounds) ground.begin_step(model.simulation.timestep, state.step);
  const auto back = [](const Vector& a) { return Vec3{a.x(), a.y(), a.z()}; };
  std::vector<ParticleContact> contacts;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    if (model.inverse_mass[i] == 0.0) continue;
    const Vector x = reference::rounded<double>(state.position[i]);
    std::optional<Vector> f;
    for (std::size_t k = 0; k < grounds.size(); ++k) {
      const Ground<double>& ground = grounds[k];
      if (!(reference::distance<double>(ground, ground.start, x) < constants.epsilon)) continue;
      if (!f) {
        const ParticleForce force = particle_force(model, springs, state, i, pull);
        f = reference::rounded<double>(force.gravity + force.springs + force.pull);
      }
      const Vector before = *f;
      f = with_contact(model, constants, ground, model.inverse_mass[i], x,
                       reference::rounded<double>(state.velocity[i]), before);
      contacts.push_back({i, k, back(reference::gap<double>(ground, ground.start, x).n), back(*f - before)});
    }
  }
  return contacts;
}

}  // namespace aspic
