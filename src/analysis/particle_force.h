#pragma once
// What pulls at one particle, in double precision whatever the state's own: for those who look at a few.
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "aspic/inputs.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// Finds the springs of a particle: those of a lattice follow from its place, and listed ones are sorted by
/// (a, b) and join particles not far apart. Costs one look at each listed spring when made, and 8 bytes.
class SpringFinder {
 public:
  explicit SpringFinder(const Model& model);
  /// Those that end at `particle`, in ascending order of their other ends. `model` is that of the
  /// constructor.
  std::vector<Spring> of(const Model& model, std::uint32_t particle) const;

 private:
  std::uint32_t widest_ = 0;  // largest b − a
};

class BodyContactForces;

/// Forces on one particle at a state [N] (docs/physics.md, sections 1 and 5).
struct ParticleForce {
  Vec3 gravity;          ///< m·g
  Vec3 drag;             ///< of the medium, against the motion
  Vec3 springs;          ///< sum over its springs
  Vec3 pull;             ///< sum over the pulls on it
  Vec3 bodies;           ///< normal forces and friction of other bodies
  Vec3 without_terrain;  ///< the sum of those above, in the solvers' order
  Vec3 applied;          ///< f: all but pins and the Coulomb model's reaction
  Vec3 contact;  ///< of terrain: the course model's force, or the reaction in the step that begins here
  Vec3 pin;      ///< what holds a pinned particle against the others
  /// The sum of all: zero at rest, but for rounding. A bounce is an impulse at a step's end and no part of
  /// it.
  Vec3 net;
};

/// The parts of ParticleForce::net in the order of their sum, for what shows or adds them.
struct ForceRow {
  std::string_view name;
  Vec3 ParticleForce::*force;
  bool external = false;  ///< acts from outside of bodies and terrain
};
inline constexpr ForceRow force_rows[] = {{"gravity", &ParticleForce::gravity, true},
                                          {"drag", &ParticleForce::drag, true},
                                          {"springs", &ParticleForce::springs},
                                          {"pull", &ParticleForce::pull, true},
                                          {"bodies", &ParticleForce::bodies},
                                          {"terrain", &ParticleForce::contact},
                                          {"pin", &ParticleForce::pin}};

/// The sum of the external ones [N].
Vec3 external_force(const ParticleForce& force);

/// The state must have the model's numbers of particles; `particle` is one of them; `inputs` are
/// those of the solver (Solver::inputs()). `bodies`: found at this state with these inputs; null: none touch.
ParticleForce particle_force(const Model& model, const SpringFinder& springs, const State& state,
                             std::uint32_t particle, const Inputs& inputs = {},
                             const BodyContactForces* bodies = nullptr);

/// Forces on one ball at a state [N]: gravity, drag and pulls, which are all of `net`; terrain, particles and
/// other balls act by impulses. The state must have the model's numbers; `ball` is one of them; `inputs`
/// are those of the solver.
ParticleForce ball_force(const Model& model, const State& state, std::uint32_t ball,
                         const Inputs& inputs = {});

}  // namespace aspic
