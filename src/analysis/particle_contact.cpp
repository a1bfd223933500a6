#include "analysis/particle_contact.h"

#include <cassert>

#include "analysis/contact_force.h"
#include "model/counts.h"
#include "model/inputs.h"

namespace aspic {
namespace {

using physics::Ground;
using Vector = physics::Vector<double>;

}  // namespace

std::vector<ParticleContact> contacts_of(const Model& model, const SpringFinder& springs, const State& state,
                                         const Inputs& inputs, const BodyContactForces* bodies) {
  assert(check_sizes(model, state));
  const physics::ContactConstants<double> constants(model);
  std::vector<Ground<double>> grounds(model.terrain.begin(), model.terrain.end());
  for (Ground<double>& ground : grounds) ground.begin_step(model.simulation.timestep, state.step);
  std::vector<ParticleContact> contacts;
  const std::span<const BodyContactForce> body_contacts =
      bodies ? bodies->forces() : std::span<const BodyContactForce>();
  auto next = body_contacts.begin();
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const double w = inverse_mass_of(model, inputs, i);
    while (next != body_contacts.end() && next->particle < i) ++next;
    if (w == 0.0) continue;
    if (next != body_contacts.end() && next->particle == i)
      contacts.push_back({i, ParticleContact::of_bodies, next->normal, next->force});
    const Vector x = physics::rounded<double>(state.position[i]);
    std::optional<Vector> f;
    for (std::size_t k = 0; k < grounds.size(); ++k) {
      const Ground<double>& ground = grounds[k];
      if (!(physics::distance<double>(ground, ground.start, x) < constants.distance)) continue;
      if (!f) {
        f = physics::rounded<double>(
            particle_force(model, springs, state, i, inputs, bodies).without_terrain);
      }
      const Vector before = *f;
      f = with_contact(model, constants, ground, w, x, physics::rounded<double>(state.velocity[i]), before);
      contacts.push_back({i, k, physics::vec3_of(physics::gap<double>(ground, ground.start, x).n),
                          physics::vec3_of(*f - before)});
    }
  }
  return contacts;
}

}  // namespace aspic
