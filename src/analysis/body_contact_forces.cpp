#include "analysis/body_contact_forces.h"

#include <algorithm>

#include "collision/contact_search.h"
#include "model/inputs.h"
#include "model/integrator.h"

namespace aspic {
namespace {

using Contact = collision::ContactSearch<double>;
using Vector = physics::Vector<double>;

/// The step h [s] at whose end implicit Euler has its normal forces; 0 for other methods.
double ahead_step(const SimulationSettings& simulation) {
  return row_of(simulation.integrator).staged() ? 0.0 : simulation.timestep;
}

}  // namespace

BodyContactForces::BodyContactForces(const Model& model) : model_(model) {
  if (has_body_contact(model)) contact_ = std::make_unique<Contact>(model, ahead_step(model.simulation));
}

BodyContactForces::BodyContactForces(const Model& model, const SpringFinder& springs, const State& state,
                                     const Inputs& inputs)
    : BodyContactForces(model) {
  find(springs, state, inputs);
}

BodyContactForces::~BodyContactForces() = default;

void BodyContactForces::find(const SpringFinder& springs, const State& state, const Inputs& inputs) {
  forces_.clear();
  if (!contact_) return;
  const auto x = physics::field<double>(state.position), v = physics::field<double>(state.velocity);
  const Contact::Particles at = {physics::components(x.data()), physics::components(v.data()), 3};
  if (!contact_->begin_step(state.step, at) || !contact_->find(at)) return;
  std::vector<Vector> before, normal_forces(contact_->particles().size(), Vector::Zero());
  for (const std::uint32_t p : contact_->particles()) {
    before.push_back(
        physics::rounded<double>(particle_force(model_, springs, state, p, inputs).without_terrain));
  }
  std::vector<Vector> after = before;
  contact_->add_forces(
      at, [&](std::uint32_t p) { return inverse_mass_of(model_, inputs, p); }, after);
  physics::spread<double>(contact_->contacts(), normal_forces,
                          [](const auto& contact) { return Vector(contact.normal_force * contact.n); });
  std::vector<bool> in_contact(before.size(), false);
  for (const auto& contact : contact_->contacts()) {
    if (!(contact.normal_force > 0.0)) continue;
    for (std::size_t n = 0; n < 5; ++n)
      if (contact.weight[n] > 0.0) in_contact[contact.place[n]] = true;
  }
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (!in_contact[n]) continue;
    const double size = normal_forces[n].norm();
    const Vector normal = size > 0.0 ? Vector(normal_forces[n] / size) : Vector(Vector::Zero());
    forces_.push_back(
        {contact_->particles()[n], physics::vec3_of(normal), physics::vec3_of(after[n] - before[n])});
  }
}

Vec3 BodyContactForces::on(std::uint32_t particle) const {
  const auto found = std::ranges::lower_bound(forces_, particle, {}, &BodyContactForce::particle);
  return found != forces_.end() && found->particle == particle ? found->force : Vec3{};
}

}  // namespace aspic
