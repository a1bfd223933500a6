#pragma once
// What a scene says about physics: plain data, SI units. Legal ranges and one-sentence meanings stand in the
// parameter table (scene/parameters.cpp), which feeds the parser, --set, `scene show` and the documentation.
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/vec3.h"

namespace aspic {

/// Time integration methods, spec §2.6.
enum class Integrator {
  explicit_euler,
  symplectic_euler,
  midpoint,
  runge_kutta_4,
  implicit_euler,
  implicit_euler_one_pass
};

/// Contact models, spec §2.5.
enum class ContactModel { coulomb, course };

enum class SpringType { structural, shear, bending };

enum class TerrainShape { plane, tilted_plane, sphere, bowl };

/// Limits of the implicit Euler solve, spec §2.6.
struct ImplicitSettings {
  int newton_iterations = 20;       ///< ≥ 1
  int cg_iterations = 200;          ///< per Newton iteration, ≥ 1
  std::optional<double> tolerance;  ///< [m/s], > 0; absent: 1e-4 single, 1e-9 double
};

struct SimulationSettings {
  Integrator integrator = Integrator::explicit_euler;
  double timestep = 0.001;          ///< h [s], > 0
  double duration = 4.0;            ///< [s], ≥ 0
  Vec3 gravity = {0.0, -9.8, 0.0};  ///< g [m/s²]
  int steps_per_frame = 8;          ///< in the window, ≥ 1
  ImplicitSettings implicit;
};

struct ContactSettings {
  ContactModel model = ContactModel::coulomb;
  double epsilon = 0.01;          ///< ε, m for distances and m/s for speeds, > 0
  double restitution = 0.8;       ///< e, 0…1, default of every terrain
  double friction = 0.3;          ///< μ, ≥ 0, default of every terrain
  double ball_restitution = 1.0;  ///< 0…1
  double ball_friction = 0.3;     ///< ≥ 0
  bool spin = true;
};

/// One terrain of the scene. Absent values take the shape's defaults (terrain_defaults) or the scene's
/// contact values.
struct TerrainSettings {
  TerrainShape shape = TerrainShape::plane;
  std::optional<Vec3> point;     ///< [m], plane and tilted plane
  std::optional<Vec3> normal;    ///< any length but zero, plane and tilted plane
  std::optional<Vec3> centre;    ///< [m], sphere and bowl
  std::optional<double> radius;  ///< [m], > 0, sphere and bowl
  std::optional<double> mass;    ///< M [kg], > 0; absent: infinite
  std::optional<double> restitution;
  std::optional<double> friction;
};

/// Stiffness and damping of the springs of one type.
struct SpringSettings {
  double stiffness = 2000.0;  ///< k [N/m], ≥ 0
  double damping = 60.0;      ///< c [N·s/m], ≥ 0
};

/// The same jelly at every resolution, spec §2.2: m = ρ·edge³/n³, k = E·s/7.3125, c = 2ζ√(k·m/2).
struct MaterialSettings {
  double density = 16.0;            ///< ρ [kg/m³], > 0
  double youngs_modulus = 33000.0;  ///< E [Pa], > 0
  double damping_ratio = 0.95;      ///< ζ, ≥ 0
};

struct RotationSettings {
  Vec3 axis = {1.0, 0.0, 1.0};  ///< any length but zero
  double angle = 0.0;           ///< [degrees]
};

/// Which particles of a cube are pinned: face and corner names, and local indices.
struct PinnedSettings {
  std::vector<std::string> names;      ///< "top", "left", … or corners such as "left-bottom-front"
  std::vector<std::uint32_t> indices;  ///< local indices i*n*n + j*n + k
};

struct CubeSettings {
  int particles_per_edge = 10;      ///< n, ≥ 2
  double edge_length = 4.0;         ///< [m], > 0
  Vec3 position = {0.0, 9.0, 0.0};  ///< of the centre [m]
  RotationSettings rotation;
  Vec3 velocity = {0.0, 0.0, 0.0};  ///< [m/s]
  double particle_mass = 1.0;       ///< m [kg], > 0
  SpringSettings structural, shear, bending;
  std::optional<MaterialSettings> material;  ///< instead of particle_mass and the three spring settings
  PinnedSettings pinned;
};

/// Everything the physics needs from a scene.
struct ModelSettings {
  SimulationSettings simulation;
  ContactSettings contact;
  std::vector<TerrainSettings> terrain;
  std::vector<CubeSettings> cubes;
};

}  // namespace aspic
