#pragma once
// The jelly cube: a lattice of n³ particles with structural, shear and bending springs.
#include "base/result.h"
#include "model/counts.h"
#include "model/model.h"

namespace aspic {

/// Springs of a cube by closed form: structural 3n²(n−1), shear 6n(n−1)² + 4(n−1)³, bending 3n²(n−2).
/// n = 10 has 2,700 + 7,776 + 2,400.
ModelCounts cube_counts(int particles_per_edge);

/// Particle mass m = ρ·edge³/n³ [kg] of a material cube.
double material_particle_mass(const MaterialSettings& material, int particles_per_edge, double edge_length);

/// Spring constants of a material cube: k = E·s/7.3125, c = 2ζ√(k·m/2), for all types. 7.3125 s⁻¹k is Young's
/// modulus of the infinite lattice with these springs along an axis (derivation in
/// docs/physics.md).
SpringSettings material_springs(const MaterialSettings& material, int particles_per_edge, double edge_length);

/// Appends the cube to the model.
/// Error (scene_rejected): an unknown face or corner name, or an index ≥ n³, in `pinned`.
Status add_cube(Model& model, const CubeSettings& cube);

}  // namespace aspic
