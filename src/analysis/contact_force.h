#pragma once
// The force of one contact, as the solvers' next step computes it; for particle_force() and contacts_of().
#include "model/model.h"
#include "physics/terrain/coulomb.h"

namespace aspic {

/// The force f [N] on a free particle at (x, v) with what a terrain adds to it: the course model's contact
/// force, or the Coulomb model's reaction if the particle rests there. `ground` has begun its step.
inline physics::Vector<double> with_contact(const Model& model,
                                            const physics::ContactConstants<double>& constants,
                                            const physics::Ground<double>& ground, double inverse_mass,
                                            const physics::Vector<double>& x,
                                            const physics::Vector<double>& v,
                                            const physics::Vector<double>& f) {
  if (model.contact.model == ContactModel::course)
    return physics::with_contact_force<double>(ground, constants, x, v, f);
  const auto at = physics::gap<double>(ground, ground.start, x);
  if (!physics::rests<double>(constants, at.d, physics::dot3<double>(ground.start.relative(v), at.n)))
    return f;
  return physics::with_reaction<double>(ground.friction, at.n,
                                        physics::least_normal_speed<double>(constants, at.d),
                                        constants.step * inverse_mass, ground.end.relative(v), f);
}

}  // namespace aspic
