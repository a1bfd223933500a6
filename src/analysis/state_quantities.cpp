// Quantities of states for other programs.
#include <cassert>
#include <cmath>

#include "analysis/particle_contact.h"
#include "aspic/analysis.h"
#include "model/counts.h"
#include "model/inputs.h"
#include "model/springs.h"
#include "physics/body_force.h"
#include "physics/pulls/law.h"

namespace aspic {
namespace {

/// Strain and tension of all springs, and what they mean for their ends.
void add_springs(const Model& model, const State& state, const Inputs& inputs, StateQuantities& q) {
  std::vector<std::uint32_t> ending(model.particle_count());
  q.mean_strain.resize(model.particle_count());
  const auto classes = physics::classes_at<double>(model, state.step, 0.0, inputs.channels);
  const bool actuated = !model.actuation.empty();
  if (actuated) q.mean_actuation.resize(model.particle_count());
  for (const Spring& s : springs_of(model)) {
    const Vec3 e = state.position[s.a] - state.position[s.b];
    const double r = classes[s.spring_class].r, r_0 = model.spring_classes[s.spring_class].rest_length;
    const physics::SpringTension<double> at(
        classes[s.spring_class], physics::rounded<double>(e),
        physics::rounded<double>(state.velocity[s.a] - state.velocity[s.b]));
    q.strain.push_back(r > 0.0 ? at.L / r - 1.0 : 0.0);
    q.tension.push_back(at.s);
    if (actuated) q.actuation.push_back(r_0 > 0.0 ? r / r_0 - 1.0 : 0.0);
    for (const std::uint32_t end : {s.a, s.b}) {
      q.mean_strain[end] += std::abs(q.strain.back());
      if (actuated) q.mean_actuation[end] += q.actuation.back();
      ++ending[end];
    }
    if (at.s == 0.0) continue;
    const Vec3 on_b = (at.s * at.q) * e;
    q.force[s.a] = q.force[s.a] - on_b;
    q.force[s.b] = q.force[s.b] + on_b;
  }
  for (std::size_t i = 0; i < ending.size(); ++i) {
    if (ending[i] == 0) continue;
    q.mean_strain[i] /= ending[i];
    if (actuated) q.mean_actuation[i] /= ending[i];
  }
}

}  // namespace

StateQuantities quantities_of(const Model& model, const State& state, const Inputs& inputs) {
  assert(check_sizes(model, state));
  StateQuantities q;
  const std::uint32_t count = model.particle_count();
  const physics::BodyForce<double> body_force(model);
  for (std::uint32_t i = 0; i < count; ++i) {
    q.speed.push_back(length(state.velocity[i]));
    q.force.push_back(
        physics::vec3_of(body_force.at(model.mass[i], physics::rounded<double>(state.velocity[i]))));
  }
  add_springs(model, state, inputs, q);
  for (const Pull& pull : inputs.pulls) {
    if (pull.ball) continue;
    q.force[pull.particle] =
        q.force[pull.particle] +
        physics::vec3_of(physics::pull_force<double>(
            physics::PullConstants<double>(pull), physics::rounded<double>(state.position[pull.particle]),
            physics::rounded<double>(state.velocity[pull.particle])));
  }
  q.contact_force.resize(count);
  q.contact.resize(count);
  const SpringFinder springs(model);
  const BodyContactForces bodies(model, springs, state, inputs);
  for (const ParticleContact& c : contacts_of(model, springs, state, inputs, &bodies)) {
    q.contact[c.particle] = 1;
    q.contact_force[c.particle] = q.contact_force[c.particle] + c.force;
    q.force[c.particle] = q.force[c.particle] + c.force;
  }
  std::uint32_t i = 0;
  for (const double w : inverse_mass_under(model, inputs)) {
    if (w == 0.0) q.force[i] = {};  // what holds it is the opposite of all else
    ++i;
  }
  return q;
}

}  // namespace aspic
