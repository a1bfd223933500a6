#pragma once
// The immutable Model: topology, masses, springs, terrain. Solvers advance a State of it; nothing ever
// changes it.
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "model/settings.h"
#include "model/state.h"
#include "model/vec3.h"

namespace aspic {

/// Springs that share their constants. A spring names its class by index.
struct SpringClass {
  SpringType type = SpringType::structural;
  double stiffness = 0.0;    ///< k [N/m]
  double damping = 0.0;      ///< c [N·s/m]
  double rest_length = 0.0;  ///< r [m]
  bool cord = false;         ///< resists stretch only
};

/// A spring between particles a < b (global indices).
struct Spring {
  std::uint32_t a = 0, b = 0;
  std::uint32_t spring_class = 0;  ///< index into Model::spring_classes
};

/// A resting surface, spec §2.4. Planes use point and normal, spheres and bowls use point (the centre) and
/// radius.
struct Terrain {
  TerrainShape shape = TerrainShape::plane;
  Vec3 point;                                             ///< a point of the plane, or the centre [m]
  Vec3 normal = {0.0, 1.0, 0.0};                          ///< unit, towards the free side (planes only)
  double radius = 0.0;                                    ///< R [m] (sphere and bowl only)
  double mass = std::numeric_limits<double>::infinity();  ///< M [kg]
  double restitution = 0.8;                               ///< e
  double friction = 0.3;                                  ///< μ
};

enum class BodyKind { cube };

/// A run of consecutive particles that was made as one body.
struct Body {
  BodyKind kind = BodyKind::cube;
  std::uint32_t first_particle = 0, particle_count = 0;
  std::uint32_t first_class = 0, class_count = 0;  ///< its spring classes
  std::array<int, 3> lattice = {0, 0, 0};          ///< particles along x, y, z
  double spacing = 0.0;                            ///< s [m] between lattice neighbours
};

/// The model. Springs are sorted by (a, b), so that adding spring forces in this order adds to every
/// particle in ascending neighbour index (spec §2.9).
struct Model {
  SimulationSettings simulation;
  ContactSettings contact;
  std::vector<Terrain> terrain;      ///< in file order: each acts on what the one before left
  std::vector<double> mass;          ///< m [kg] of each particle, > 0, finite for pinned particles too
  std::vector<double> inverse_mass;  ///< w [1/kg], 0 = pinned
  std::vector<SpringClass> spring_classes;
  std::vector<Spring> springs;
  std::vector<Body> bodies;
  std::vector<Vec3> initial_position, initial_velocity;

  std::uint32_t particle_count() const { return static_cast<std::uint32_t>(mass.size()); }
};

/// Makes the model the settings describe. Errors (scene_rejected): an unknown pinned name or index, more
/// particles than 32-bit indices or free memory hold. The settings' ranges are the caller's business
/// (scene/validate).
Result<Model> build_model(const ModelSettings& settings);

/// The state a run starts from, rounded to `precision`; −0 becomes +0.
State initial_state(const Model& model, Precision precision);

/// Approach speed below which a contact is at rest: max(ε, 2|g|h) [m/s], spec §2.5.
double resting_speed(const Model& model);

/// Springs and pinned particles of a model, for reports.
struct ModelCounts {
  std::uint64_t particles = 0, pinned = 0, structural = 0, shear = 0, bending = 0;
  std::uint64_t springs() const { return structural + shear + bending; }
};
ModelCounts count(const Model& model);

/// Counts without building: for memory checks before anything is allocated. Pinned particles are not counted.
ModelCounts predict_counts(const ModelSettings& settings);

/// Bytes a Model with these counts holds.
std::uint64_t model_bytes(const ModelCounts& counts);

/// Every integrator, in the order of spec §2.6.
inline constexpr Integrator all_integrators[] = {
    Integrator::explicit_euler, Integrator::symplectic_euler, Integrator::midpoint,
    Integrator::runge_kutta_4,  Integrator::implicit_euler,   Integrator::implicit_euler_one_pass};

/// Names as they stand in scene files and reports.
std::string_view name_of(Integrator integrator);
std::string_view name_of(ContactModel model);
std::string_view name_of(SpringType type);
std::string_view name_of(TerrainShape shape);

}  // namespace aspic
