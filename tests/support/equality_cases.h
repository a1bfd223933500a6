#pragma once
// Runs in which solvers are compared bit by bit: a covering set of method × terrain × contact × force path ×
// bodies × ground × form of the lattice kernel.
#include <cstdint>
#include <string>
#include <vector>

#include "gpu_solver/gpu_solver.h"
#include "model/model.h"

namespace aspic::test {

/// Bodies of a case. Together they have every kind of body_rows(), and springs in lattices and in lists.
enum class Bodies { cube, listed_cube, cloth, cube_and_balls, all, box, voxels, robot };

/// What the terrain does to them.
enum class Ground {
  bouncing,  ///< default restitution and friction
  holding,   ///< hardly bounces, has_friction, is movable: bodies come to rest on it
  moving     ///< to and fro
};

struct EqualityCase {
  Integrator integrator;
  TerrainShape shape;
  ContactModel contact;
  ForcePath path;
  Bodies bodies;
  Ground ground;
  std::uint32_t lattice_run;  ///< GpuOptions::lattice_run
};

/// Every pair of values that work together occurs (support/covering.h).
const std::vector<EqualityCase>& covering_cases();

/// What the case's bits depend on, in words: "a cloth on a bowl that holds, coulomb". Without the method.
std::string scene_of(const EqualityCase& row);
/// With the method, the path and the form, for messages.
std::string text_of(const EqualityCase& row);
/// The bodies just above the terrain, falling.
ModelSettings settings_of(const EqualityCase& row);
/// The model of these settings; springs are listed where the case wants it.
Model model_of(const EqualityCase& row);
/// So many that bodies meet the ground, and some come to rest on it.
std::uint64_t steps_of(const EqualityCase& row);

/// Moves bodies up or down until the nearest particle or ball of those launched is `gap` [m] from terrain.
void set_down(ModelSettings& settings, double gap);

}  // namespace aspic::test
