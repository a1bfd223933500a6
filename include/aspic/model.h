#pragma once
// The immutable Model: particles, springs, terrain. Solvers advance a State of it; nothing ever changes it.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/settings.h"
#include "aspic/state.h"

namespace aspic {

/// A model, whose members are the library's own (src/model/model.h).
struct Model;
/// A model that all who compute with it hold together: it lives as long as any of them.
/// Any number of threads may use one model at once.
using SharedModel = std::shared_ptr<const Model>;

/// Makes the model the settings describe. Errors (scene_rejected): an unknown pinned name or index, more
/// particles than 32-bit indices or free memory hold, a number that is not finite in single precision. Other
/// values are taken as they are: aspic/scene.h checks ranges, of a scene changed by code through
/// with_overrides().
ASPIC_API Result<SharedModel> make_model(const ModelSettings& settings);

/// Settings for a run that is at `time` [s]: where a frequency of a terrain's motion or of an actuator
/// differs from `before` and its phase does not, the phase becomes the one with which motion and signal go
/// on.
ASPIC_API ModelSettings with_continuous_phases(ModelSettings settings, const ModelSettings& before,
                                               double time);

/// The state a run starts from, rounded to `precision`; −0 becomes +0.
ASPIC_API State initial_state(const Model& model, Precision precision);

/// Whether a solver of the one model can go over to the other (Solver::set_constants()): both have the same
/// particles, balls, springs and their classes, drives of actuators, lattices, kinds of terrain and of its
/// motion, contact model and integrator. Error (usage): the first of these that differs.
ASPIC_API Status check_same_topology(const Model& from, const Model& to);

/// Actuators that read a channel of the inputs, by channel: their names, or `actuator[0]`.
ASPIC_API std::vector<std::string> input_names(const Model& model);

/// Consecutive particles that were made as one body.
struct ParticleRange {
  std::uint32_t first = 0, count = 0;  ///< the first global index; how many there are
};
/// The bodies of particles, in the order of their kinds in ModelSettings and then of their lists.
ASPIC_API std::vector<ParticleRange> particle_ranges(const Model& model);
/// The mass of every particle [kg], > 0, of pinned ones too.
ASPIC_API std::vector<double> particle_masses(const Model& model);
/// Indices of the particles that are pinned, ascending.
ASPIC_API std::vector<std::uint32_t> pinned_indices(const Model& model);

/// A spring between the particles a < b.
struct SpringFacts {
  std::uint32_t a = 0, b = 0;                ///< global indices
  SpringType type = SpringType::structural;  ///< by the place of its ends in the lattice
  double stiffness = 0.0;                    ///< k [N/m]
  double damping = 0.0;                      ///< c [N·s/m]
  double rest_length = 0.0;                  ///< r [m]
  bool cord = false;                         ///< resists stretch only
};
/// Every spring, sorted by (a, b).
ASPIC_API std::vector<SpringFacts> spring_facts(const Model& model);

/// Four particles counterclockwise, seen from outside or from the side that an open surface turns to.
using Quad = std::array<std::uint32_t, 4>;
/// The surface of the body at an index of particle_ranges(); nothing for nets.
ASPIC_API std::vector<Quad> surface_quads(const Model& model, std::size_t body);

/// A ball: a solid sphere. Those of [[ball]] come first, in file order, then those of the launchers.
struct BallFacts {
  double radius = 0.0;            ///< R [m]
  double mass = 0.0;              ///< m [kg], > 0
  std::uint64_t launch_step = 0;  ///< takes part in the steps that begin at this step number or later
};
/// Every ball, by its index in a State.
ASPIC_API std::vector<BallFacts> ball_facts(const Model& model);

}  // namespace aspic
