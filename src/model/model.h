#pragma once
// The immutable Model: topology, masses, springs, terrain. Solvers advance a State of it; nothing ever
// changes it.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/error.h"
#include "aspic/model.h"
#include "aspic/settings.h"
#include "aspic/state.h"
#include "aspic/vec.h"
#include "model/actuation.h"
#include "model/lattice.h"
#include "model/particle_data.h"
#include "model/quad_mesh.h"
#include "model/skin.h"

namespace aspic {

/// Springs that share their constants. A spring names its class by index.
struct SpringClass {
  SpringType type = SpringType::structural;
  double stiffness = 0.0;    ///< k [N/m]
  double damping = 0.0;      ///< c [N·s/m]
  double rest_length = 0.0;  ///< r [m], of actuated ones r₀: rest_lengths() has what it is at a time
  bool cord = false;         ///< resists stretch only
};

/// A spring between particles a < b (global indices).
struct Spring {
  std::uint32_t a = 0, b = 0;
  std::uint32_t spring_class = 0;  ///< index into Model::spring_classes

  friend bool operator==(const Spring&, const Spring&) = default;
};

/// A resting surface; by default the plane y = 0.
struct Terrain {
  TerrainShape shape = TerrainShape::plane;
  /// Places [m], unit directions and lengths [m].
  Geometry<double> geometry = {.vectors = {Vec3{}, Vec3{0.0, 1.0, 0.0}}};
  double mass = std::numeric_limits<double>::infinity();  ///< M [kg]
  double restitution = 0.8;                               ///< e
  double friction = 0.3;                                  ///< μ
  std::optional<TerrainMotion> motion = {};               ///< of unit direction; absent: it never moves
};

/// How a body is drawn when it is drawn solid.
enum class SurfaceStyle {
  flesh,  ///< a closed surface, the skin of a translucent solid
  sheet,  ///< an open surface, opaque and lit from both sides
  cords   ///< no surface: its structural springs, as cords
};

/// A straight rod with round ends that is drawn with a body and never moves.
struct Rod {
  Vec3 from, to;        ///< [m], not the same point
  double radius = 0.0;  ///< [m]
};

/// A mesh that is drawn in place of a body's surface, and follows its particles: skin_positions().
struct BodySkin {
  SkinBinding binding;
  std::vector<std::array<std::uint32_t, 8>> corners;  ///< particles, global indices, by vertex
  std::vector<Triangle> triangles;

  bool empty() const { return triangles.empty(); }
};

/// A run of consecutive particles that was made as one body. Solvers need only the particles and springs;
/// the rest is for analysis, images and files.
struct Body {
  std::uint32_t first_particle = 0, particle_count = 0;
  std::uint32_t first_class = 0, class_count = 0;  ///< its spring classes
  /// The lattice that its particles and springs are, of the classes from first_class on, none of them cords.
  /// Springs and surface of one whose cells are all full follow from it: neither is listed.
  std::optional<Lattice> lattice;

  SurfaceStyle style = SurfaceStyle::flesh;
  QuadMesh listed_surface;  ///< none where it follows from the lattice; of cords meshes that touch, not drawn
  double size = 0.0;        ///< of flesh: its largest extent [m], for how deep light reaches
  BodySkin skin;            ///< none for most
  std::vector<Rod> rods;    ///< what it hangs on
  bool footballs = false;   ///< balls are drawn as footballs where it is
  std::optional<double> friction;  ///< μ against other bodies; absent: contact.body_friction

  /// The lattice from which its springs and surface follow, or nullptr.
  const Lattice* box() const { return lattice && lattice->all_full() ? &*lattice : nullptr; }
};

/// The surface of a body, none for cords.
QuadMesh surface_of(const Body& body);

/// A ball: a solid sphere. Those of [[ball]] come first, in file order, then those of the launchers.
struct Ball {
  double radius = 0.0;            ///< R [m]
  double mass = 0.0;              ///< m [kg], > 0
  std::uint64_t launch_step = 0;  ///< takes part in the steps that begin at this step number or later
  Vec3 initial_position;          ///< [m]; a ball that is not launched yet waits here
  Vec3 initial_velocity;          ///< [m/s]
  Vec3 initial_angular_velocity;  ///< ω [rad/s]

  double inertia() const { return 0.4 * mass * radius * radius; }  ///< I = 2/5·m·R² [kg·m²]
  /// Whether it takes part in the step that begins with a state of this step number.
  bool launched(std::uint64_t step) const { return step >= launch_step; }
};

/// The model. Its springs are walked by springs_of (model/springs.h) in the order of (a, b), so that adding
/// their forces in this order adds to every particle in ascending neighbor index.
struct Model {
  SimulationSettings simulation;
  ContactSettings contact;
  std::vector<Terrain> terrain;  ///< in file order: each acts on what the one before left
  Runs<double> mass;             ///< m [kg] of each particle, > 0, finite for pinned particles too
  Runs<double> inverse_mass;     ///< w [1/kg], 0 = pinned
  std::vector<SpringClass> spring_classes;
  std::vector<Spring> listed_springs;  ///< sorted by (a, b); without those of lattices
  std::vector<Body> bodies;
  Places initial_position;
  Runs<Vec3> initial_velocity;  ///< [m/s]
  std::vector<Ball> balls;
  Actuation actuation;  ///< of which spring classes the rest lengths change, and how

  std::uint32_t particle_count() const { return static_cast<std::uint32_t>(mass.size()); }
  std::uint32_t ball_count() const { return static_cast<std::uint32_t>(balls.size()); }
};

inline SharedModel shared(Model model) {
  return std::make_shared<const Model>(std::move(model));
}

/// Particles and balls of a model together at most: as many as signed 32-bit indices can name.
inline constexpr std::uint64_t most_indices = 0x7fffffff;

/// Makes the model the settings describe. Errors (scene_rejected): an unknown pinned name or index, more
/// particles than 32-bit indices or free memory hold, a number that is not finite in single precision. Other
/// values are taken as they are: aspic/scene.h checks ranges, of a scene changed by code through
/// with_overrides().
Result<Model> build_model(const ModelSettings& settings);

/// Whether the models, of as many particles, pin the same ones.
bool same_pins(const Model& a, const Model& b);

}  // namespace aspic
