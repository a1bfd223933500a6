#pragma once
// Where particles touch terrain, and the force of the contact, in double precision.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/particle_force.h"

namespace aspic {

/// A particle nearer than ε to a terrain.
struct ParticleContact {
  std::uint32_t particle = 0;
  std::size_t terrain = 0;  ///< index in Model::terrain
  Vec3 normal;              ///< unit, from the terrain towards the particle
  /// On the particle [N]: the course model's contact force; in the Coulomb model the reaction that a particle
  /// at rest on the ground feels in the step that begins with this state, from the forces at its start
  /// (docs/physics.md). Zero of a particle that only touches: its bounce is an impulse, which no state holds.
  Vec3 force;
};

/// All contacts at a state, in ascending order of particles, then of terrains. Pinned particles have none.
/// `state`, `springs` and `inputs` as in particle_force().
std::vector<ParticleContact> contacts_of(const Model& model, const SpringFinder& springs, const State& state,
                                         const Inputs& inputs = {});

}  // namespace aspic
