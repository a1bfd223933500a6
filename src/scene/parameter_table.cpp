#include <algorithm>
#include <type_traits>

#include "model/model.h"
#include "model/solver.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

// ---- conversions between a field of the settings and a Value ----

std::optional<Value> to_value(const Parameter&, bool field) {
  return Value(field);
}
std::optional<Value> to_value(const Parameter&, int field) {
  return Value(std::int64_t{field});
}
std::optional<Value> to_value(const Parameter&, double field) {
  return Value(field);
}
std::optional<Value> to_value(const Parameter&, const std::string& field) {
  return Value(field);
}
std::optional<Value> to_value(const Parameter&, const Vec3& field) {
  return Value(field);
}
std::optional<Value> to_value(const Parameter&, const PinnedSettings& field) {
  return Value(field);
}
template <class T>
std::optional<Value> to_value(const Parameter&, const std::optional<T>& field) {
  return field ? std::optional<Value>(*field) : std::nullopt;
}
template <class Enum>
requires std::is_enum_v<Enum> std::optional<Value> to_value(const Parameter&, Enum field) {
  return Value(std::string(name_of(field)));
}
std::optional<Value> to_value(const Parameter& p, const DrawSettings& field) {
  const bool drawn[] = {field.solid, field.particles, field.structural, field.shear, field.bending};
  std::vector<std::string> words;
  for (std::size_t i = 0; i < p.words.size(); ++i) {
    if (drawn[i]) words.emplace_back(p.words[i]);
  }
  return Value(words);
}

template <class T>
void from_value(const Parameter&, T& field, const Value& value) {
  field = std::get<T>(value);
}
void from_value(const Parameter&, int& field, const Value& value) {
  field = static_cast<int>(std::get<std::int64_t>(value));
}
template <class T>
void from_value(const Parameter&, std::optional<T>& field, const Value& value) {
  field = std::get<T>(value);
}
template <class Enum>
requires std::is_enum_v<Enum>
void from_value(const Parameter& p, Enum& field, const Value& value) {
  const auto word = std::find(p.words.begin(), p.words.end(), std::get<std::string>(value));
  field = static_cast<Enum>(word - p.words.begin());
}
void from_value(const Parameter& p, DrawSettings& field, const Value& value) {
  const auto& words = std::get<std::vector<std::string>>(value);
  bool* const drawn[] = {&field.solid, &field.particles, &field.structural, &field.shear, &field.bending};
  for (std::size_t i = 0; i < p.words.size(); ++i) {
    *drawn[i] = std::find(words.begin(), words.end(), p.words[i]) != words.end();
  }
}

/// The words of an enumeration whose values count from 0.
template <class Enum>
std::vector<std::string_view> words_of(Enum last) {
  std::vector<std::string_view> words;
  for (int i = 0; i <= static_cast<int>(last); ++i) words.push_back(name_of(static_cast<Enum>(i)));
  return words;
}

// ---- rows ----

/// A row whose field `Access` finds in a scene: a stateless generic lambda (scene, index) -> field&.
template <class Access>
Parameter row(std::string_view path, ParameterType type, Access, std::string_view meaning) {
  Parameter p;
  p.path = path;
  p.type = type;
  p.meaning = meaning;
  p.read = [](const Parameter& self, const Scene& scene, std::size_t index) {
    return to_value(self, Access{}(scene, index));
  };
  p.write = [](const Parameter& self, Scene& scene, std::size_t index, const Value& value) {
    from_value(self, Access{}(scene, index), value);
  };
  return p;
}

template <class Access>
Parameter number(std::string_view path, std::string_view unit, Range range, Access access,
                 std::string_view meaning) {
  Parameter p = row(path, ParameterType::number, access, meaning);
  p.unit = unit;
  p.range = range;
  return p;
}

template <class Access>
Parameter integer(std::string_view path, Range range, Access access, std::string_view meaning) {
  Parameter p = row(path, ParameterType::integer, access, meaning);
  p.range = range;
  return p;
}

template <class Access>
Parameter vector(std::string_view path, std::string_view unit, double largest, Access access,
                 std::string_view meaning) {
  Parameter p = row(path, ParameterType::vector, access, meaning);
  p.unit = unit;
  p.range = {-largest, largest};
  return p;
}

template <class Access>
Parameter word(std::string_view path, std::vector<std::string_view> words, Access access,
               std::string_view meaning) {
  Parameter p = row(path, ParameterType::word, access, meaning);
  p.words = std::move(words);
  return p;
}

template <class Access>
Parameter direction(std::string_view path, Access access, std::string_view meaning) {
  Parameter p = vector(path, "", 1e6, access, meaning);
  p.direction = true;
  return p;
}

Parameter fixed(Parameter p) {
  p.live = false;
  return p;
}

Parameter of(Belonging belonging, Parameter p) {
  p.belonging = belonging;
  return p;
}

Parameter absent(std::string_view meaning_of_absence, Parameter p) {
  p.when_absent = meaning_of_absence;
  return p;
}

// Ends of ranges that a formula does not give keep every product the solvers form far inside single
// precision.
constexpr double far = 1e6;        // m
constexpr double longest = 1e6;    // s
constexpr double stiffest = 1e12;  // N/m, Pa
constexpr double heaviest = 1e9;   // kg, kg/m³
constexpr Range positive_length = {0.0, far, true};
constexpr Range fraction = {0.0, 1.0};
constexpr Range friction = {0.0, 1e6};
constexpr Range stiffness = {0.0, stiffest};
constexpr Range damping = {0.0, 1e9};

// A stateless lambda that finds a field in a const or mutable scene; `i` is the index of the terrain or cube.
#define FIELD(expression)                                    \
  [](auto& scene, [[maybe_unused]] std::size_t i) -> auto& { \
    return scene.expression;                                 \
  }
#define MATERIAL(field)                                                          \
  [](auto& scene, std::size_t i) -> auto& {                                      \
    auto& chosen = scene.model.cubes[i].material;                                \
    if constexpr (!std::is_const_v<std::remove_reference_t<decltype(chosen)>>) { \
      if (!chosen) chosen.emplace();                                             \
    }                                                                            \
    return chosen->field;                                                        \
  }

constexpr auto planes = Belonging::plane;
constexpr auto round = Belonging::round;
constexpr auto springs = Belonging::explicit_springs;
constexpr auto material = Belonging::material;
constexpr std::string_view of_shape = "by shape";

std::vector<Parameter> root_rows() {
  Parameter schema;
  schema.path = "schema";
  schema.type = ParameterType::integer;
  schema.range = {scene_schema, scene_schema};
  schema.when_absent = "required";
  schema.meaning = "Version of the scene file format.";
  schema.read = [](const Parameter&, const Scene&, std::size_t) {
    return std::optional<Value>(std::int64_t{scene_schema});
  };
  schema.write = [](const Parameter&, Scene&, std::size_t, const Value&) {};
  return {
      fixed(schema),
      fixed(absent("the file's name without ending", row("name", ParameterType::text, FIELD(name),
                                                         "Title of the scene in windows and reports."))),
  };
}

std::vector<Parameter> simulation_rows() {
  return {
      word("simulation.integrator", words_of(Integrator::implicit_euler_one_pass),
           FIELD(model.simulation.integrator), "Time integration method."),
      number("simulation.timestep", "s", {0.0, 1.0, true}, FIELD(model.simulation.timestep), "Time step h."),
      number("simulation.duration", "s", {0.0, longest}, FIELD(model.simulation.duration),
             "Simulated time of a run for which neither steps nor duration are asked."),
      vector("simulation.gravity", "m/s²", 1e4, FIELD(model.simulation.gravity),
             "Gravitational acceleration g."),
      integer("simulation.steps-per-frame", {1, 100000}, FIELD(model.simulation.steps_per_frame),
              "Time steps between two pictures in the window."),
      integer("simulation.implicit.newton-iterations", {1, 1000},
              FIELD(model.simulation.implicit.newton_iterations),
              "Most Newton iterations of one implicit Euler step."),
      integer("simulation.implicit.cg-iterations", {1, 100000},
              FIELD(model.simulation.implicit.cg_iterations),
              "Most conjugate gradient iterations within one Newton iteration."),
      absent("0.0001 in single precision, 1e-9 in double",
             number("simulation.implicit.tolerance", "m/s", {0.0, 1.0, true},
                    FIELD(model.simulation.implicit.tolerance),
                    "Largest residual component at which an implicit Euler step counts as converged.")),
  };
}

std::vector<Parameter> contact_rows() {
  return {
      word("contact.model", words_of(ContactModel::course), FIELD(model.contact.model),
           "Contact law: Coulomb friction, or the original assignments' formulas."),
      number("contact.epsilon", "m, m/s", {0.0, 1.0, true}, FIELD(model.contact.epsilon),
             "Distance and approach speed below which a particle touches."),
      number("contact.restitution", "", fraction, FIELD(model.contact.restitution),
             "Part of the approach speed that a bounce gives back, for every terrain without its own."),
      number("contact.friction", "", friction, FIELD(model.contact.friction),
             "Friction coefficient of every terrain without its own."),
      number("contact.ball-restitution", "", fraction, FIELD(model.contact.ball_restitution),
             "Restitution between balls, and between balls and particles."),
      number("contact.ball-friction", "", friction, FIELD(model.contact.ball_friction),
             "Friction coefficient between balls, and between balls and particles."),
      row("contact.spin", ParameterType::boolean, FIELD(model.contact.spin),
          "Whether friction makes balls rotate."),
  };
}

std::vector<Parameter> terrain_rows() {
  return {
      word("terrain[].shape", words_of(TerrainShape::bowl), FIELD(model.terrain[i].shape),
           "Shape of the resting surface; a bowl is the inside of a sphere."),
      of(planes, absent(of_shape, vector("terrain[].point", "m", far, FIELD(model.terrain[i].point),
                                         "A point of the plane."))),
      of(planes, absent(of_shape, direction("terrain[].normal", FIELD(model.terrain[i].normal),
                                            "Direction to the free side; its length does not matter."))),
      of(round, absent(of_shape, vector("terrain[].centre", "m", far, FIELD(model.terrain[i].centre),
                                        "Centre of the sphere or bowl."))),
      of(round, absent(of_shape, number("terrain[].radius", "m", positive_length,
                                        FIELD(model.terrain[i].radius), "Radius of the sphere or bowl."))),
      absent("infinite", number("terrain[].mass", "kg", {0.0, heaviest, true}, FIELD(model.terrain[i].mass),
                                "Mass M in the bounce speed (m − e·M)/(m + M)·u; the terrain never moves.")),
      absent("that of [contact]",
             number("terrain[].restitution", "", fraction, FIELD(model.terrain[i].restitution),
                    "Restitution of this terrain.")),
      absent("that of [contact]", number("terrain[].friction", "", friction, FIELD(model.terrain[i].friction),
                                         "Friction coefficient of this terrain.")),
  };
}

std::vector<Parameter> cube_rows() {
  return {
      fixed(integer("cube[].particles-per-edge", {2, 512}, FIELD(model.cubes[i].particles_per_edge),
                    "Particles n along each edge, n³ in all.")),
      fixed(number("cube[].edge-length", "m", positive_length, FIELD(model.cubes[i].edge_length),
                   "Edge of the undeformed cube.")),
      fixed(vector("cube[].position", "m", far, FIELD(model.cubes[i].position),
                   "Centre of the cube at the start.")),
      fixed(direction("cube[].rotation.axis", FIELD(model.cubes[i].rotation.axis),
                      "Axis through the centre about which the cube is turned; its length does not matter.")),
      fixed(number("cube[].rotation.angle", "°", {-36000.0, 36000.0}, FIELD(model.cubes[i].rotation.angle),
                   "Angle of that turn, right-handed.")),
      fixed(vector("cube[].velocity", "m/s", divergence_speed, FIELD(model.cubes[i].velocity),
                   "Velocity of the particles that are not pinned at the start.")),
      of(springs, number("cube[].particle-mass", "kg", {0.0, heaviest, true},
                         FIELD(model.cubes[i].particle_mass), "Mass m of each particle.")),
      of(springs,
         number("cube[].structural.stiffness", "N/m", stiffness, FIELD(model.cubes[i].structural.stiffness),
                "Stiffness k of the springs between axis neighbours.")),
      of(springs,
         number("cube[].structural.damping", "N·s/m", damping, FIELD(model.cubes[i].structural.damping),
                "Damping c of the springs between axis neighbours.")),
      of(springs, number("cube[].shear.stiffness", "N/m", stiffness, FIELD(model.cubes[i].shear.stiffness),
                         "Stiffness k of the springs along face and body diagonals.")),
      of(springs, number("cube[].shear.damping", "N·s/m", damping, FIELD(model.cubes[i].shear.damping),
                         "Damping c of the springs along face and body diagonals.")),
      of(springs,
         number("cube[].bending.stiffness", "N/m", stiffness, FIELD(model.cubes[i].bending.stiffness),
                "Stiffness k of the springs between particles two steps apart along an axis.")),
      of(springs, number("cube[].bending.damping", "N·s/m", damping, FIELD(model.cubes[i].bending.damping),
                         "Damping c of the springs between particles two steps apart along an axis.")),
      of(material, number("cube[].material.density", "kg/m³", {0.0, heaviest, true}, MATERIAL(density),
                          "Density ρ, from which m = ρ·edge³/n³.")),
      of(material,
         number("cube[].material.youngs-modulus", "Pa", {0.0, stiffest, true}, MATERIAL(youngs_modulus),
                "Young's modulus E along an axis, from which k = E·s/7.3125 at spacing s.")),
      of(material, number("cube[].material.damping-ratio", "", {0.0, 1e6}, MATERIAL(damping_ratio),
                          "Damping ratio ζ, from which c = 2ζ√(k·m/2).")),
      fixed(row("cube[].pinned", ParameterType::pinned, FIELD(model.cubes[i].pinned),
                "Particles that never move: faces, corners such as left-top-front, or local indices.")),
  };
}

std::vector<Parameter> view_rows() {
  Parameter draw =
      word("view.draw", {"solid", "particles", "structural", "shear", "bending"}, FIELD(view.draw),
           "Parts of the bodies that are drawn: surface, particles, springs by type.");
  draw.type = ParameterType::words;
  return {
      vector("view.camera.position", "m", far, FIELD(view.camera.position), "Position of the eye."),
      vector("view.camera.target", "m", far, FIELD(view.camera.target),
             "Point in the middle of the picture."),
      number("view.camera.fov", "°", {1.0, 179.0}, FIELD(view.camera.fov), "Vertical field of view."),
      draw,
      word("view.colour", words_of(ViewColour::speed), FIELD(view.colour),
           "What the colours of bodies mean."),
  };
}

#undef FIELD
#undef MATERIAL

}  // namespace

std::string_view name_of(ViewColour colour) {
  switch (colour) {
    case ViewColour::material:
      return "material";
    case ViewColour::type:
      return "type";
    case ViewColour::strain:
      return "strain";
    case ViewColour::force:
      return "force";
    case ViewColour::speed:
      return "speed";
  }
  return "";
}

std::span<const Parameter> parameters() {
  static const std::vector<Parameter> table = [] {
    std::vector<Parameter> all;
    for (auto rows :
         {root_rows(), simulation_rows(), contact_rows(), terrain_rows(), cube_rows(), view_rows()}) {
      all.insert(all.end(), rows.begin(), rows.end());
    }
    return all;
  }();
  return table;
}

}  // namespace aspic
