#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <string>

#include "model/integrator.h"
#include "model/terrain.h"
#include "scene/parameter_rows.h"

namespace aspic {
namespace {

using namespace rows;

Rows root_rows() {
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
      fixed(absent("the file's name without extension",
                   row("name", FIELD(name), "Title of the scene in windows and reports."))),
      absent("no name", row("author", FIELD(author),
                            "Name or number of its author, shown in videos and on a report's first "
                            "page.")),
  };
}

Rows simulation_rows() {
  return {
      word<all_integrators>("simulation.integrator", FIELD(model.simulation.integrator),
                            "Time integration method."),
      row("simulation.timestep", "s", {0.0, 1.0, true}, FIELD(model.simulation.timestep), "Time step h."),
      row("simulation.duration", "s", {0.0, longest}, FIELD(model.simulation.duration),
          "Simulated time of a run, unless it sets steps or a duration."),
      row("simulation.gravity", "m/s²", within(1e4), FIELD(model.simulation.gravity),
          "Gravitational acceleration g."),
      row("simulation.drag", "1/s", {0.0, 1000.0}, FIELD(model.simulation.drag),
          "Linear drag γ: the force -γ·m·v on every particle and ball."),
      row("simulation.steps-per-frame", "", {1, 100000}, FIELD(model.simulation.steps_per_frame),
          "Time steps between two frames in the window."),
      row("simulation.implicit.newton-iterations", "", {1, 1000},
          FIELD(model.simulation.implicit.newton_iterations),
          "Largest number of Newton iterations in an implicit Euler step."),
      row("simulation.implicit.cg-iterations", "", {1, 100000},
          FIELD(model.simulation.implicit.cg_iterations),
          "Largest number of conjugate gradient iterations in a Newton iteration."),
      absent("0.0001 in single precision, 1e-9 in double",
             row("simulation.implicit.tolerance", "m/s", {0.0, 1.0, true},
                 FIELD(model.simulation.implicit.tolerance),
                 "Largest residual component at which an implicit Euler step counts as converged.")),
  };
}

Rows contact_rows() {
  return {
      word<contact_models>(
          "contact.model", FIELD(model.contact.model),
          "Contact law: Coulomb contact with rest, or the formulas of the original assignments."),
      row("contact.distance", "m", {0.0, 1.0, true}, FIELD(model.contact.distance),
          "Distance from terrain within which particles and balls are in contact with it."),
      row("contact.resting-speed", "m/s", {0.0, 1.0, true}, FIELD(model.contact.resting_speed),
          "Normal speed up to which they may rest; faster impacts bounce."),
      row("contact.restitution", "", fraction, FIELD(model.contact.restitution),
          "Coefficient of restitution of terrains that do not set their own."),
      row("contact.friction", "", friction, FIELD(model.contact.friction),
          "Friction coefficient of terrains that do not set their own."),
      row("contact.ball-restitution", "", fraction, FIELD(model.contact.ball_restitution),
          "Restitution between balls, and between balls and particles."),
      row("contact.ball-friction", "", friction, FIELD(model.contact.ball_friction),
          "Friction coefficient between balls, and between balls and particles."),
      row("contact.spin", FIELD(model.contact.spin), "Makes balls rotate by friction."),
      fixed(row("contact.bodies", FIELD(model.contact.bodies), "Enable contact between bodies.")),
      fixed(row("contact.self", FIELD(model.contact.self),
                "Enable contact of each body with itself, between parts that are apart at rest.")),
      row("contact.body-friction", "", friction, FIELD(model.contact.body_friction),
          "Friction coefficient of bodies that do not set their own; the smaller of the two applies."),
      row("contact.body-gap", "", {0.0, 1.0, true}, FIELD(model.contact.body_gap),
          "Distance at which normal forces between bodies begin, in spacings of their particles."),
      row("contact.body-damping", "", fraction, FIELD(model.contact.body_damping),
          "Damping ratio ζ of these normal forces."),
  };
}

/// A key of terrain geometry. Its path is kept for the program's life.
Parameter geometry_row(const GeometryKey& key) {
  static std::deque<std::string> paths;
  Parameter p;
  p.path = paths.emplace_back(fmt::format("terrain[].{}", key.name));
  p.type = key.kind == GeometryKind::length ? ParameterType::number : ParameterType::vector;
  p.unit = key.kind == GeometryKind::direction ? "" : "m";
  p.range = key.kind == GeometryKind::length ? positive_length : within(far);
  p.direction = key.kind == GeometryKind::direction;
  p.belonging = Belonging::geometry;
  p.when_absent = "by shape";
  p.meaning = key.meaning;
  p.read = [](const Parameter& self, const Scene& scene, std::size_t i) -> std::optional<Value> {
    const auto& geometry = scene.model.terrain[i].geometry;
    const auto found = geometry.find(self.key());
    return found == geometry.end() ? std::nullopt : std::optional(as_value(found->second));
  };
  p.write = [](const Parameter& self, Scene& scene, std::size_t i, const Value& value) {
    GeometryValue& into = scene.model.terrain[i].geometry[std::string(self.key())];
    if (self.type == ParameterType::number) {
      into = std::get<double>(value);
    } else {
      into = std::get<Vec3>(value);
    }
  };
  p.erase = [](const Parameter& self, Scene& scene, std::size_t i) {
    scene.model.terrain[i].geometry.erase(std::string(self.key()));
  };
  return p;
}

Rows terrain_rows() {
  Rows rows = {word<terrain_shapes>("terrain[].shape", FIELD(model.terrain[i].shape),
                                    "Shape of the terrain; a bowl is the inside of a sphere.")};
  rows.front().live = false;  // another one would begin somewhere inside the bodies
  for (const TerrainShapeRow& shape : terrain_shapes) {
    for (const GeometryKey& key : shape.keys) {
      Parameter geometry = geometry_row(key);
      if (std::ranges::find(rows, geometry.path, &Parameter::path) == rows.end())
        rows.push_back(std::move(geometry));
    }
  }
  const Rows others = {
      absent("infinite",
             row("terrain[].mass", "kg", positive_mass, FIELD(model.terrain[i].mass),
                 "Mass M in the bounce speed (m − e·M)/(m + M)·u; a bounce never moves the terrain.")),
      absent("that of [contact]", row("terrain[].restitution", "", fraction,
                                      FIELD(model.terrain[i].restitution), "Restitution of this terrain.")),
      absent("that of [contact]", row("terrain[].friction", "", friction, FIELD(model.terrain[i].friction),
                                      "Friction coefficient of this terrain.")),
  };
#define MOTION(field) FIELD_IN(model.terrain[i].motion, field)
  const Rows motion =
      of(Belonging::motion,
         {direction(row("terrain[].motion.direction", MOTION(direction),
                        "Direction of the terrain's oscillation, of any length.")),
          row("terrain[].motion.amplitude", "m", {0.0, far}, MOTION(amplitude),
              "Largest displacement A; the terrain is displaced by A·sin 2π(f·t + φ)."),
          row("terrain[].motion.frequency", "Hz", {0.0, 1e4}, MOTION(frequency), "Frequency f."),
          row("terrain[].motion.phase", "turns", within(1e6), MOTION(phase), "Phase φ.")});
  return joined({rows, others, motion});
}

Rows view_rows() {
  Parameter draw = row("view.draw", FIELD(view.draw),
                       "Parts of the bodies to render: surface, particles, springs by type.");
  draw.words = {"solid", "particles", "structural", "shear", "bending"};
  Parameter arrows = row("view.arrows", FIELD(view.arrows),
                         "Arrows at particles: contact points with normals and forces; the sum of spring "
                         "forces; gravity and mouse pulls; all together.");
  arrows.words = {"contacts", "springs", "external", "net"};
  Parameter follow =
      absent("a fixed camera", row("view.follow", FIELD(view.follow),
                                   "Body or ball for the camera to follow, such as \"cube[0]\", \"ball[2]\" "
                                   "or a body's name; \"none\" is the default."));
  follow.write = [](const Parameter&, Scene& scene, std::size_t, const Value& value) {
    const auto& name = std::get<std::string>(value);
    scene.view.follow = name == "none" ? std::nullopt : std::optional(name);
  };
  Parameter position =
      row("view.camera.position", "m", within(far), FIELD(view.camera.position),
          "Position of the camera. Without position and target, the camera shows the bodies at the start.");
  position.write = [](const Parameter&, Scene& scene, std::size_t, const Value& value) {
    scene.view.camera.position = std::get<Vec3>(value);
    scene.view.aimed = false;
  };
  Parameter target = row("view.camera.target", "m", within(far), FIELD(view.camera.target),
                         "Point at the center of the image.");
  target.write = [](const Parameter&, Scene& scene, std::size_t, const Value& value) {
    scene.view.camera.target = std::get<Vec3>(value);
    scene.view.aimed = false;
  };
  return {
      position,
      target,
      row("view.camera.fov", "°", {1.0, 179.0}, FIELD(view.camera.fov), "Vertical field of view."),
      word<projections>(
          "view.camera.projection", FIELD(view.camera.projection),
          "Perspective, or orthographic: parallel, with the height of the field of view at the target."),
      draw,
      follow,
      word<view_colors>("view.color", FIELD(view.color), "Quantity to show as the colors of bodies."),
      word<cut_insides>("view.cut.inside", FIELD(view.cut.inside),
                        "Inside of bodies in a cut: a filled section in their colors, or the springs in "
                        "front of one; off: no cut."),
      direction(row("view.cut.normal", FIELD(view.cut.normal),
                    "Normal of the cut's plane, towards the hidden side.")),
      row("view.cut.offset", "m", within(far), FIELD(view.cut.offset),
          "Distance of the cut's plane from the world's origin, along its normal."),
      row("view.terrain", FIELD(view.terrain), "Shows terrain; bodies collide with it in either case."),
      row("view.axes", FIELD(view.axes), "Shows the world's axes in a corner of the image."),
      arrows,
      absent("as long as fits the image", row("view.arrow-scale", "N/m", {0.0, 1e12, true},
                                              FIELD(view.arrow_scale), "Force of an arrow of one meter.")),
      word<scale_maps>("view.scale.map", FIELD(view.scale.map),
                       "Colors of the scale; automatic: blue-red for signed strain, else violet-yellow."),
      word<scale_ranges>("view.scale.range", FIELD(view.scale.range),
                         "Ends of the scale: fixed for the run, those of each image (automatic), or those of "
                         "each image with 0 in the middle (symmetric)."),
      absent("by scene", row("view.scale.from", "", within(1e12), FIELD(view.scale.from),
                             "Value at the lower end of a fixed scale, in N, J or m/s; strain as a ratio.")),
      absent("by scene", row("view.scale.to", "", within(1e12), FIELD(view.scale.to),
                             "Value at the upper end of a fixed scale, in N, J or m/s; strain as a ratio.")),
      absent("none", row("view.ground", "m", within(far), FIELD(view.ground),
                         "Height of a level grid without contact.")),
  };
}

}  // namespace

std::string_view name_of(ViewColor color) {
  return std::ranges::find(view_colors, color, &Named<ViewColor>::value)->name;
}
std::string_view name_of(ScaleMap map) {
  return std::ranges::find(scale_maps, map, &Named<ScaleMap>::value)->name;
}
std::string_view name_of(ScaleRange range) {
  return std::ranges::find(scale_ranges, range, &Named<ScaleRange>::value)->name;
}

std::string_view name_of(CutInside inside) {
  return std::ranges::find(cut_insides, inside, &Named<CutInside>::value)->name;
}

std::string_view name_of(Projection projection) {
  return std::ranges::find(projections, projection, &Named<Projection>::value)->name;
}

std::span<const Parameter> parameters() {
  static const Rows table =
      joined({root_rows(), simulation_rows(), contact_rows(), terrain_rows(), material_parameters(),
              body_parameters(), actuator_parameters(), view_rows()});
  return table;
}

}  // namespace aspic
