#pragma once
// Physics of a scene: plain data, SI units. The parameter table (scene/parameter_table.cpp) has legal ranges
// and meanings for the parser, overrides, `scene show` and the documentation.
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "aspic/export.h"
#include "aspic/vec.h"

namespace aspic {

/// Time integration methods.
enum class Integrator {
  explicit_euler,
  symplectic_euler,
  midpoint,
  runge_kutta_4,
  implicit_euler,
  implicit_euler_one_pass,
  heun_3,
  velocity_verlet
};

/// Shapes of terrain; src/model/shapes has a file for each.
enum class TerrainShape { plane, tilted_plane, sphere, bowl, torus, plane_with_hole };

/// The value of a key of a terrain's geometry: a vector (place, direction) or a number (length).
using GeometryValue = std::variant<double, Vec3>;

/// Most vectors, and most numbers, of one shape.
inline constexpr std::size_t geometry_size = 3;

/// A shape's geometry. In GLSL, terrains[t].geometry[k] is (vector k, number k).
template <class T>
struct Geometry {
  std::array<Vec<T>, geometry_size> vectors = {};  ///< in the order of the keys that hold vectors
  std::array<T, geometry_size> numbers = {};       ///< in the order of the keys that hold numbers
};

/// Contact models.
enum class ContactModel { coulomb, course };

/// A value of an enumeration, or a member of settings, with its name in scene files and reports.
template <class Value>
struct Named {
  Value value;            ///< one of the enumeration or settings
  std::string_view name;  ///< unique within it
};

/// Every contact model, in the order in which they are listed for users.
inline constexpr Named<ContactModel> contact_models[] = {{ContactModel::coulomb, "coulomb"},
                                                         {ContactModel::course, "course"}};

/// Classes of springs in a lattice.
enum class SpringType { structural, shear, bending };

/// Limits of the implicit Euler solve.
struct ImplicitSettings {
  int newton_iterations = 20;       ///< ≥ 1
  int cg_iterations = 200;          ///< per Newton iteration, ≥ 1
  std::optional<double> tolerance;  ///< [m/s], > 0; absent: 1e-4 single, 1e-9 double
};

/// Time and gravity.
struct SimulationSettings {
  Integrator integrator = Integrator::explicit_euler;  ///< of every particle
  double timestep = 0.001;                             ///< h [s], > 0
  double duration = 4.0;                               ///< [s], ≥ 0
  Vec3 gravity = {0.0, -9.8, 0.0};                     ///< g [m/s²]
  int steps_per_frame = 8;                             ///< in the window, ≥ 1
  ImplicitSettings implicit;                           ///< for implicit-euler alone
  double drag = 0.0;  ///< γ [1/s], ≥ 0: the force −γ·m·v on every particle and ball
};

/// Constants of the forces by which the medium resists motion (src/physics/body_force.h), ≥ 0: their keys in
/// [simulation], in the order of `resistance_constants` in shaders.
inline constexpr Named<double SimulationSettings::*> resistance_constants[] = {
    {&SimulationSettings::drag, "drag"}};

/// Contact of particles and balls with terrain, of balls with each other, and of bodies.
struct ContactSettings {
  ContactModel model = ContactModel::coulomb;  ///< docs/physics.md, section 5
  double distance = 0.01;                      ///< ε [m], > 0: within it a body is in contact with terrain
  double resting_speed = 0.01;                 ///< v_s [m/s], > 0: slower bodies in contact rest
  double restitution = 0.8;                    ///< e, 0…1, default of every terrain
  double friction = 0.3;                       ///< μ, ≥ 0, default of every terrain
  double ball_restitution = 1.0;               ///< 0…1
  double ball_friction = 0.3;                  ///< ≥ 0
  bool spin = true;                            ///< whether friction makes balls rotate
  bool bodies = true;                          ///< whether bodies touch each other (docs/contact.md)
  bool self = false;                           ///< whether a body touches itself
  double body_friction = 0.3;  ///< μ, ≥ 0, default of every body; of two the smaller counts
  double body_gap = 0.1;       ///< ρ, where normal forces begin, in spacings, > 0 … 1
  double body_damping = 0.2;   ///< ζ of normal forces, 0…1
};

/// How a terrain moves to and fro: displaced by amplitude·sin 2π(frequency·t + phase) along a direction.
struct TerrainMotion {
  Vec3 direction = {0.0, 1.0, 0.0};  ///< any length but zero; in a Model a unit vector
  double amplitude = 1.0;            ///< [m], ≥ 0
  double frequency = 0.25;           ///< [Hz], ≥ 0
  double phase = 0.0;                ///< in turns
};

/// One terrain. Absent values are the shape's defaults (terrain_shapes) or the scene's contact values.
struct TerrainSettings {
  TerrainShape shape = TerrainShape::plane;  ///< decides which keys `geometry` may have
  /// By key, of the kind that the key has: shapes say which keys they have.
  std::map<std::string, GeometryValue, std::less<>> geometry = {};
  std::optional<double> mass = {};           ///< M [kg], > 0; absent: infinite
  std::optional<double> restitution = {};    ///< e, 0…1; absent: the scene's
  std::optional<double> friction = {};       ///< μ, ≥ 0; absent: the scene's
  std::optional<TerrainMotion> motion = {};  ///< absent: it never moves
};

/// Stiffness and damping of the springs of one type.
struct SpringSettings {
  double stiffness = 2000.0;  ///< k [N/m], ≥ 0
  double damping = 60.0;      ///< c [N·s/m], ≥ 0
};

/// The same jelly at every resolution: m = ρ·edge³/n³, k = E·s/7.3125, c = 2ζ√(k·m/2).
struct MaterialSettings {
  double density = 16.0;            ///< ρ [kg/m³], > 0
  double youngs_modulus = 33000.0;  ///< E [Pa], > 0
  double damping_ratio = 0.95;      ///< ζ, ≥ 0
  /// In ModelSettings::materials its name; in a body that of the material to use instead of the numbers.
  std::string name = {};
};

/// A rotation by an angle about an axis, right-handed.
struct RotationSettings {
  Vec3 axis = {1.0, 0.0, 1.0};  ///< any length but zero
  double angle = 0.0;           ///< [degrees]
};

/// Which particles of a body are pinned: names of sides and corners, and local indices.
struct PinnedSettings {
  std::vector<std::string> names;     ///< "top", "left", … or corners such as "left-bottom-front"
  std::vector<std::int64_t> indices;  ///< local indices, each 0 … the body's particle count − 1

  friend bool operator==(const PinnedSettings&, const PinnedSettings&) = default;
};

/// Of the library: how it makes a model of a kind of body. Each kind declares its own.
struct BodyRow;

/// A cube of particles, n³ in a lattice; or a box, whose neighbors are equally far apart in all directions.
struct CubeSettings {
  int particles_per_edge = 10;                       ///< n, ≥ 2; without `particles`
  std::optional<std::array<int, 3>> particles = {};  ///< of a box: along x, y and z, each ≥ 2
  double edge_length = 4.0;                          ///< [m], > 0; of a box the longest edge
  Vec3 position = {0.0, 9.0, 0.0};                   ///< of the center [m]
  RotationSettings rotation;                         ///< about the center
  Vec3 velocity = {0.0, 0.0, 0.0};                   ///< [m/s]
  double particle_mass = 1.0;                        ///< m [kg], > 0
  SpringSettings structural, shear, bending;         ///< by type; without `material`
  std::optional<MaterialSettings> material;  ///< instead of particle_mass and the three spring settings
  std::optional<double> friction;            ///< μ against bodies, ≥ 0; absent: contact.body_friction
  PinnedSettings pinned;                     ///< none by default

  /// Particles along each axis.
  std::array<int, 3> lattice() const {
    return particles.value_or(std::array{particles_per_edge, particles_per_edge, particles_per_edge});
  }
  friend BodyRow row_of(const CubeSettings&);
};

/// What becomes of cells that hang together in several pieces, by the faces they share.
enum class Pieces { refuse, largest, all };

/// Every choice, in the order in which they are listed for users.
inline constexpr Named<Pieces> piece_choices[] = {
    {Pieces::refuse, "refuse"}, {Pieces::largest, "largest"}, {Pieces::all, "all"}};

/// Layers of cells upwards (y), each of rows from back to front (z), each of characters from left to right
/// (x): '.', '0' and ' ' are empty, any other stands for a material.
using CellLayers = std::vector<std::vector<std::string>>;
/// Materials by the character of their cells.
using CellPalette = std::map<std::string, std::string, std::less<>>;

/// A body of cubic cells, each of a material or empty; particles are at their corners.
struct VoxelsSettings {
  std::string name = {};                               ///< unique where it is not empty
  double size = 0.5;                                   ///< edge of a cell [m], > 0
  Vec3 position = {0.0, 6.0, 0.0};                     ///< of the center of all cells, the empty ones too [m]
  RotationSettings rotation = {{0.0, 1.0, 0.0}, 0.0};  ///< about that center
  Vec3 velocity = {0.0, 0.0, 0.0};                     ///< [m/s]
  CellLayers layers = {{"1.1", "1.1"}, {"111", "111"}};  ///< as many rows, and as many characters, in each
  CellPalette palette = {};             ///< names of ModelSettings::materials; empty: all are of `material`
  MaterialSettings material = {};       ///< of every cell where there is no palette
  Pieces pieces = Pieces::refuse;       ///< of several
  std::optional<double> friction = {};  ///< μ against bodies, ≥ 0; absent: contact.body_friction
  PinnedSettings pinned = {};           ///< none by default
  std::string skin = {};  ///< a mesh drawn in place of the cells' faces, as scenes keep it; empty: none
  friend BodyRow row_of(const VoxelsSettings&);
};

/// Springs of a net that may be left out.
struct OptionalSpringSettings {
  double stiffness = 0.0;  ///< k [N/m], ≥ 0; 0: there are no such springs
  double damping = 50.0;   ///< c [N·s/m], ≥ 0
};

/// A goal net: back, top and two sides of a box; its front (+x) and its bottom are open.
struct GoalNetSettings {
  std::array<int, 3> particles = {10, 20,
                                  35};  ///< nw, nh, nl along width (x), height (y), length (z), each ≥ 2
  Vec3 size = {2.0, 3.0, 8.0};          ///< width, height, length [m], each > 0
  Vec3 position = {0.0, 0.6, 0.0};      ///< of the box's center [m]
  double particle_mass = 0.2;           ///< m [kg], > 0
  SpringSettings structural = {1500.0, 50.0};  ///< between neighbors
  OptionalSpringSettings shear, bending;       ///< none by default
  std::optional<MaterialSettings> material;    ///< of its cords, instead of mass and springs
  double cord_diameter = 0.01;                 ///< d [m], > 0; with `material`
  bool cord = false;                           ///< springs resist stretch only
  friend BodyRow row_of(const GoalNetSettings&);
};

/// A rectangular cloth: w × h particles, in the x–y plane before it is turned.
struct ClothSettings {
  std::array<int, 2> particles = {24, 16};  ///< w, h along its width (x) and height (y), each ≥ 2
  std::array<double, 2> size = {3.0, 2.0};  ///< width, height [m], each > 0
  Vec3 position = {0.0, 3.0, 0.0};          ///< of the center [m]
  RotationSettings rotation = {{0.0, 1.0, 0.0}, 0.0};  ///< about the center
  Vec3 velocity = {0.0, 0.0, 0.0};                     ///< [m/s]
  double particle_mass = 0.02;                         ///< m [kg], > 0
  SpringSettings structural = {400.0, 0.8}, shear = {200.0, 0.4}, bending = {20.0, 0.04};  ///< by type
  std::optional<MaterialSettings> material;  ///< instead of particle_mass and the three spring settings
  double thickness = 0.001;                  ///< t [m], > 0; with `material`
  std::optional<double> friction;            ///< μ against bodies, ≥ 0; absent: contact.body_friction
  PinnedSettings pinned;                     ///< none by default

  /// Particles along each axis: one layer.
  std::array<int, 3> lattice() const { return {particles[0], particles[1], 1}; }
  friend BodyRow row_of(const ClothSettings&);
};

/// A ball: a solid sphere, inertia 2/5·m·R².
struct BallSettings {
  double radius = 0.3;                      ///< R [m], > 0
  double mass = 1.0;                        ///< m [kg], > 0
  Vec3 position = {7.0, 2.6, 2.0};          ///< of the center [m]
  Vec3 velocity = {-49.0, -14.0, -7.0};     ///< [m/s]
  Vec3 angular_velocity = {0.0, 0.0, 0.0};  ///< ω [rad/s]
  friend BodyRow row_of(const BallSettings&);
};

/// A box from which points are drawn.
struct BoxSettings {
  Vec3 min, max;  ///< [m], min ≤ max in every component
};

/// Radius and mass of a launcher's balls.
struct LaunchedBallSettings {
  double radius = 0.3;  ///< R [m], > 0
  double mass = 1.0;    ///< m [kg], > 0
};

/// Throws balls at random, the same ones for the same seed (model/launcher.h).
struct LauncherSettings {
  std::int64_t seed = 1;  ///< ≥ 0
  int count = 10;         ///< balls, ≥ 0
  double interval = 0.5;  ///< [s] between two balls, ≥ 0; the first comes at the start
  BoxSettings from = {{5.0, 0.6, 0.0}, {9.0, 4.6, 4.0}};     ///< starts are drawn from it
  BoxSettings towards = {{0.0, 0.6, 0.0}, {0.0, 0.6, 2.0}};  ///< targets are drawn from it
  double speed_factor = 7.0;  ///< [1/s], velocity = factor · (target − start)
  LaunchedBallSettings ball;  ///< all alike
  friend BodyRow row_of(const LauncherSettings&);
};

/// The course of an actuator's signal w, in periods θ = f·(t − start) + φ.
enum class Signal {
  sine,      ///< sin 2πθ
  square,    ///< 1 in the first half of a period, −1 in the second
  triangle,  ///< 0 at 0, 1 at ¼, −1 at ¾
  table,     ///< linear between the points of ActuatorSettings::table, again and again
  input      ///< a channel of the inputs (aspic/inputs.h), which knows no phase
};

/// Every signal, in the order in which they are listed for users.
inline constexpr Named<Signal> actuator_signals[] = {{Signal::sine, "sine"},
                                                     {Signal::square, "square"},
                                                     {Signal::triangle, "triangle"},
                                                     {Signal::table, "table"},
                                                     {Signal::input, "input"}};

/// An axis of a body's own frame, before it is turned.
enum class BodyAxis { none, x, y, z };

/// Which way an actuator stretches: the first, BodyAxis::none, is every way alike.
inline constexpr Named<BodyAxis> actuator_axes[] = {
    {BodyAxis::none, "all"}, {BodyAxis::x, "x"}, {BodyAxis::y, "y"}, {BodyAxis::z, "z"}};

/// Along which axis a phase grows.
inline constexpr Named<BodyAxis> phase_axes[] = {
    {BodyAxis::none, "none"}, {BodyAxis::x, "x"}, {BodyAxis::y, "y"}, {BodyAxis::z, "z"}};

/// Points [θ, w] of a signal: θ in periods, from 0, ascending; the last one's is the length of the table.
using SignalTable = std::vector<std::array<double, 2>>;

/// Which cells and springs of its bodies an actuator acts on: those that pass all that is given. Cells are
/// those of cubes and bodies of cells; springs of cloths and nets count as cells, with their middles.
struct SelectSettings {
  std::vector<std::string> materials = {};  ///< names of [[material]]; none: any
  std::optional<BoxSettings> box = {};      ///< has the middle of the cell, in the body's own frame [m]
  CellLayers voxels = {};                   ///< a mask as VoxelsSettings::layers; none: all cells
  std::vector<std::string> springs = {};    ///< names of SpringType; none: all
};

/// The phase φ of a signal [cycles]: offset − x/wavelength + that of the cell, where x is the cell's middle
/// along an axis, from the body's center. So a wave runs towards the axis' positive end where the wavelength
/// is positive.
struct PhaseSettings {
  double offset = 0.0;              ///< [cycles]
  BodyAxis along = BodyAxis::none;  ///< none: the same everywhere
  double wavelength = 1.0;          ///< [m], not 0; with `along`
  /// One number for each cell of the layers: "nx ny nz: …", ordered by x, y and z; empty: 0.
  std::string cells = {};
};

/// Makes springs' rest lengths follow a signal: r(t) = r₀·(1 + a·w(t)). docs/actuation.md has the law.
struct ActuatorSettings {
  std::string name = {};                     ///< unique where it is not empty
  std::vector<std::string> bodies = {};      ///< names, or `cube[0]`; none: every body of particles
  SelectSettings select = {};                ///< everything by default
  BodyAxis axis = BodyAxis::none;            ///< stretches that way alone; none: all ways alike
  double amplitude = 0.1;                    ///< a, of rest length; without `volume_change`
  std::optional<double> volume_change = {};  ///< v at w = 1: 1 + v = (1 + a)³, along one axis 1 + a
  Signal signal = Signal::sine;              ///< w
  double frequency = 1.0;                    ///< f [Hz], ≥ 0
  SignalTable table = {{0.0, 0.0}, {0.25, 1.0}, {0.75, -1.0}, {1.0, 0.0}};  ///< with Signal::table
  PhaseSettings phase = {};                                                 ///< 0 by default
  double start = 0.0;  ///< [s] before which w is 0, ≥ 0
  double ramp = 0.0;   ///< [s] in which w grows to its full size, ≥ 0
};

/// Everything the physics needs from a scene.
struct ModelSettings {
  SimulationSettings simulation;            ///< time step, method and gravity
  ContactSettings contact;                  ///< defaults of every terrain, and of balls
  std::vector<TerrainSettings> terrain;     ///< in file order, as all lists here
  std::vector<MaterialSettings> materials;  ///< those that have names, for every body
  std::vector<CubeSettings> cubes;          ///< each ≥ 2³ particles
  std::vector<VoxelsSettings> voxels;       ///< bodies of cells
  std::vector<GoalNetSettings> goal_nets;   ///< open boxes of springs
  std::vector<ClothSettings> cloths;        ///< rectangles
  std::vector<BallSettings> balls;          ///< there from step 0
  std::vector<LauncherSettings> launchers;  ///< their balls come one by one
  std::vector<ActuatorSettings> actuators;  ///< several may act on one cell: what they add to it is added up
};

/// The kinds of bodies, in the order in which the model makes them and files list them.
inline constexpr std::tuple body_lists = {&ModelSettings::cubes,     &ModelSettings::voxels,
                                          &ModelSettings::goal_nets, &ModelSettings::cloths,
                                          &ModelSettings::balls,     &ModelSettings::launchers};

/// Names in scene files and reports.
ASPIC_API std::string_view name_of(Integrator integrator);
ASPIC_API std::string_view name_of(ContactModel model);
ASPIC_API std::string_view name_of(SpringType type);
ASPIC_API std::string_view name_of(Pieces pieces);
ASPIC_API std::string_view name_of(Signal signal);
ASPIC_API std::string_view name_of(TerrainShape shape);

}  // namespace aspic
