#pragma once
// Where particles touch terrain or other bodies, and the force of the contact, in double precision.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/body_contact_forces.h"

namespace aspic {

/// A particle nearer than ε to a terrain, or with normal forces of other bodies.
struct ParticleContact {
  static constexpr std::size_t of_bodies = static_cast<std::size_t>(-1);
  std::uint32_t particle = 0;
  std::size_t terrain = 0;  ///< index in Model::terrain, or of_bodies
  Vec3 normal;              ///< unit, from the terrain towards the particle; of bodies as BodyContactForce
  /// On the particle [N]: of bodies their normal forces and friction; the course model's contact force; in
  /// the Coulomb model the reaction that a particle at rest on the ground feels in the step that begins with
  /// this state, from the forces at its start (docs/physics.md). Zero of a particle that only touches: its
  /// bounce is an impulse, which no state holds.
  Vec3 force;
};

/// All contacts at a state, in ascending order of particles, then of bodies before terrains. Pinned particles
/// have none. `state`, `springs`, `inputs` and `bodies` as in particle_force().
std::vector<ParticleContact> contacts_of(const Model& model, const SpringFinder& springs, const State& state,
                                         const Inputs& inputs = {},
                                         const BodyContactForces* bodies = nullptr);

}  // namespace aspic
