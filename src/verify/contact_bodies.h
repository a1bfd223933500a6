#pragma once
// Bodies that the rows of contact between them share.
#include <algorithm>
#include <array>

#include "verify/experiments.h"

namespace aspic::verify {

inline constexpr double contact_spacing = 4.0 / 9;  ///< s of the default cube [m]

/// A box of so many particles at the default cube's spacing.
inline CubeSettings box_at(const std::array<int, 3>& particles, const Vec3& center) {
  CubeSettings box;
  box.particles = particles;
  box.edge_length = (std::ranges::max(particles) - 1) * contact_spacing;
  box.position = center;
  return box;
}

/// Mean of the places or velocities of a body's particles.
inline Vec3 mean_of(const std::vector<Vec3>& of, const Body& body) {
  Vec3 sum;
  for (std::uint32_t i = 0; i < body.particle_count; ++i) sum = sum + of[body.first_particle + i];
  return (1.0 / body.particle_count) * sum;
}

/// Contacts between bodies in a state.
struct ContactSample {
  std::size_t count = 0;
  double least = 1.0, greatest = -1.0;  ///< distances among them, in spacings
  double first_step = 0.0;  ///< Σ ½k·(h·u)², the energy that a first step in contact may bring [J]
};
ContactSample sample_contacts(const Model& model, const State& state);

}  // namespace aspic::verify
