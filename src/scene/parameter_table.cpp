#include "scene/parameter_rows.h"

namespace aspic {
namespace {

using namespace rows;

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

std::vector<std::string_view> integrator_words() {
  std::vector<std::string_view> words;
  for (const IntegratorRow& row : integrator_table) words.push_back(row.name);
  return words;
}

std::vector<Parameter> simulation_rows() {
  return {
      word("simulation.integrator", integrator_words(),
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
         {root_rows(), simulation_rows(), contact_rows(), terrain_rows(), body_rows(), view_rows()}) {
      all.insert(all.end(), rows.begin(), rows.end());
    }
    return all;
  }();
  return table;
}

}  // namespace aspic
