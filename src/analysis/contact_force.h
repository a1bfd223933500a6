#pragma once
// The force of one contact, as the solvers' next step computes it; for particle_force() and contacts_of().
#include "cpu_reference/coulomb.h"
#include "model/model.h"

namespace aspic {

/// The force f [N] on a free particle at (x, v) with what a terrain adds to it: the course model's contact
/// force, or the Coulomb model's reaction if the particle rests there. `ground` has begun its step.
inline reference::Vector<double> with_contact(const Model& model,
                                              const reference::ContactConstants<double>& constants,
                                              const reference::Ground<double>& ground, double inverse_mass,
                                              const reference::Vector<double>& x,
                                              const reference::Vector<double>& v,
                                              const reference::Vector<double>& f) {
  if (model.contact.model == ContactModel::course)
    return reference::with_contact_force<double>(ground, constants.epsilon, x, v, f);
  const auto at = reference::gap<double>(ground, ground.start, x);
  if (!reference::rests<double>(constants, at.d, reference::dot3<double>(ground.start.relative(v), at.n)))
    return f;
  return reference::with_reaction<double>(ground.friction, at.n,
                                          reference::least_normal_speed<double>(constants, at.d),
                                          constants.step * inverse_mass, ground.end.relative(v), f);
}

}  // namespace aspic
