#pragma once
// The jelly cube, and the box: a lattice of particles with structural, shear and bending springs.
#include <array>

#include "aspic/vec.h"
#include "base/result.h"
#include "model/counts.h"
#include "model/model.h"

namespace aspic {

/// Particles and springs of a lattice n₀ × n₁ × n₂ by closed form. For n³ particles: structural 3n²(n−1),
/// shear 6n(n−1)² + 4(n−1)³, bending 3n²(n−2); n = 10 has 2,700 + 7,776 + 2,400.
ModelCounts box_counts(const std::array<int, 3>& particles);

/// Distance of neighbors s [m]: the longest edge over one less than its particles.
double spacing_of(const CubeSettings& cube);
/// Lengths of the edges along x, y and z [m].
Vec3 edges_of(const CubeSettings& cube);

/// Particles along x, y and z of the same body with `longest` along its longest edge: its other edges are as
/// long as before to within half a spacing, or as 2 particles are. `longest` ≥ 2.
std::array<int, 3> with_longest_edge(const CubeSettings& cube, int longest);

/// Gives the body so many particles along its longest edge, and its other edges as with_longest_edge().
void resize(CubeSettings& cube, int longest);

/// Particle mass [kg] of a cube of a material: density times volume over the number of particles.
double material_particle_mass(const CubeSettings& cube);

/// Spring constants of a cube of a material: k = E·s/7.3125, c = 2ζ√(k·m/2), for all types. 7.3125 s⁻¹k is
/// Young's modulus of the infinite lattice with these springs along an axis (derivation in
/// docs/physics.md).
SpringSettings material_springs(const CubeSettings& cube);

/// Appends the cube to the model.
/// Errors (scene_rejected): an unknown face or corner name, or an index that is no particle, in `pinned`; a
/// material that the scene does not have.
Status add_cube(Model& model, const ModelSettings& settings, const CubeSettings& cube);

}  // namespace aspic
