#include "aspic/solver.h"
#include "mesh/voxelize.h"
#include "model/bodies.h"
#include "scene/parameter_rows.h"

namespace aspic {
namespace {

using namespace rows;

/// The key `pinned` of a kind of body, with the names that the kind knows.
Parameter pins(std::string_view body, Parameter p) {
  const auto list_key = [](const BodyRow& row) { return row.list.key; };
  p.pins = std::ranges::find(body_rows(), body, list_key)->pins;
  p.words = p.pins->words();
  return p;
}

// Stiffness and damping of a body's springs of one type; `which` ends "the springs …".
#define SPRINGS(list, type, field, which)                                           \
  row(list "[]." type ".stiffness", "N/m", stiffness, FIELD(model.field.stiffness), \
      "Stiffness k of the springs " which "."),                                     \
      row(list "[]." type ".damping", "N·s/m", damping, FIELD(model.field.damping), \
          "Damping c of the springs " which ".")

// Where a body is at the start, and how it moves.
#define START(list, body, position_meaning, axis_meaning)                                             \
  fixed(row(list "[].position", "m", within(far), FIELD(model.body.position), position_meaning)),     \
      fixed(direction(row(list "[].rotation.axis", FIELD(model.body.rotation.axis), axis_meaning))),  \
      fixed(row(list "[].rotation.angle", "°", {-36000.0, 36000.0}, FIELD(model.body.rotation.angle), \
                "Rotation angle, right-handed.")),                                                    \
      fixed(row(list "[].velocity", "m/s", within(divergence_speed), FIELD(model.body.velocity),      \
                "Initial velocity of the particles that are not pinned."))

// μ of a body against others.
#define BODY_FRICTION(list, body)                                          \
  absent("contact.body-friction",                                          \
         row(list "[].friction", "", friction, FIELD(model.body.friction), \
             "Friction coefficient between bodies; the smaller of the two applies."))

/// Particles along the edges of a cube: one number, or three, of which the one that is set last counts.
Rows particle_rows() {
  Parameter edges =
      fixed(row("cube[].particles-per-edge", "", {2, 512}, FIELD(model.cubes[i].particles_per_edge),
                "Particles n along each edge, n³ in all."));
  edges.write = [](const Parameter& p, Scene& scene, std::size_t i, const Value& value) {
    from_value(p, scene.model.cubes[i].particles_per_edge, value);
    scene.model.cubes[i].particles.reset();
  };
  Parameter box =
      fixed(absent("a cube", row("cube[].particles", "", {2, 4096}, FIELD(model.cubes[i].particles),
                                 "Particles along the edges of a box, at most 512³ in all; the spacing is "
                                 "the same in all directions.")));
  edges.belonging = Belonging::equal_edges;
  box.belonging = Belonging::box;
  return {edges, box};
}

/// Keys of the material that a body is made of, whose numbers decide masses and springs.
#define MATERIAL_ROWS(list, access, density_meaning, modulus_meaning)                                        \
  Rows {                                                                                                     \
    of_name(row(list "[].material.name", access(name), "Name of its [[material]], instead of the values.")), \
        of_numbers(                                                                                          \
            row(list "[].material.density", "kg/m³", positive_mass, access(density), density_meaning)),      \
        of_numbers(row(list "[].material.youngs-modulus", "Pa", {0.0, stiffest, true},                       \
                       access(youngs_modulus), modulus_meaning)),                                            \
        of_numbers(row(list "[].material.damping-ratio", "", {0.0, 1e6}, access(damping_ratio),              \
                       "Damping ratio ζ, from which c = 2ζ√(k·m/2)."))                                       \
  }

Parameter of_name(Parameter p) {
  p.belonging = Belonging::material_name;
  p.when_absent = "none: the values are here";
  return p;
}
Parameter of_numbers(Parameter p) {
  p.belonging = Belonging::material_numbers;
  return p;
}

Rows cube_rows() {
#define MATERIAL(field) FIELD_IN(model.cubes[i].material, field)
  return joined(
      {particle_rows(),
       {fixed(row("cube[].edge-length", "m", positive_length, FIELD(model.cubes[i].edge_length),
                  "Longest edge of the undeformed cube or box.")),
        START("cube", cubes[i], "Center of the cube at the start.",
              "Rotation axis through the center, of any length.")},
       of(Belonging::explicit_springs,
          {row("cube[].particle-mass", "kg", positive_mass, FIELD(model.cubes[i].particle_mass),
               "Mass m of each particle."),
           SPRINGS("cube", "structural", cubes[i].structural, "between axis neighbors"),
           SPRINGS("cube", "shear", cubes[i].shear, "along face and body diagonals"),
           SPRINGS("cube", "bending", cubes[i].bending, "between particles two steps apart along an axis")}),
       MATERIAL_ROWS("cube", MATERIAL,
                     "Density ρ, from which m = ρ·edge³/n³, or ρ·volume over the particles of a box.",
                     "Young's modulus E along an axis, from which k = E·s/7.3125 at spacing s."),
       {BODY_FRICTION("cube", cubes[i]),
        fixed(pins("cube", row("cube[].pinned", FIELD(model.cubes[i].pinned),
                               "Particles that never move: faces, corners such as left-top-front, or local "
                               "indices.")))}});
}

Rows net_rows() {
#define NET_MATERIAL(field) FIELD_IN(model.goal_nets[i].material, field)
  return joined(
      {{fixed(row("goal-net[].particles", "", {2, 512}, FIELD(model.goal_nets[i].particles),
                  "Lattice points nw, nh, nl along width (x), height (y) and length (z).")),
        fixed(row("goal-net[].size", "m", positive_length, FIELD(model.goal_nets[i].size),
                  "Width, height and length; the front, towards +x, and the bottom are open.")),
        fixed(row("goal-net[].position", "m", within(far), FIELD(model.goal_nets[i].position),
                  "Center of the box."))},
       of(Belonging::explicit_springs,
          {row("goal-net[].particle-mass", "kg", positive_mass, FIELD(model.goal_nets[i].particle_mass),
               "Mass m of each particle."),
           SPRINGS("goal-net", "structural", goal_nets[i].structural, "between axis neighbors"),
           fixed(row(
               "goal-net[].shear.stiffness", "N/m", stiffness, FIELD(model.goal_nets[i].shear.stiffness),
               "Stiffness k of the springs along the diagonals of the faces' cells; 0: no such springs.")),
           row("goal-net[].shear.damping", "N·s/m", damping, FIELD(model.goal_nets[i].shear.damping),
               "Damping c of the springs along face diagonals."),
           fixed(row("goal-net[].bending.stiffness", "N/m", stiffness,
                     FIELD(model.goal_nets[i].bending.stiffness),
                     "Stiffness k of the springs between particles two steps apart in a face; 0: there are "
                     "none.")),
           row("goal-net[].bending.damping", "N·s/m", damping, FIELD(model.goal_nets[i].bending.damping),
               "Damping c of the springs between particles two steps apart.")}),
       MATERIAL_ROWS("goal-net", NET_MATERIAL,
                     "Density ρ of the cords, whose mass the particles share equally.",
                     "Young's modulus E of the cords, from which k = E·π/4·d²/ℓ of one of length ℓ."),
       of(Belonging::material, {row("goal-net[].cord-diameter", "m", positive_length,
                                    FIELD(model.goal_nets[i].cord_diameter), "Diameter d of the cords.")}),
       {row("goal-net[].cord", FIELD(model.goal_nets[i].cord),
            "Makes the springs resist stretch only, as cords do.")}});
}

Rows cloth_rows() {
#define CLOTH_MATERIAL(field) FIELD_IN(model.cloths[i].material, field)
  return joined(
      {{fixed(row("cloth[].particles", "", {2, 512}, FIELD(model.cloths[i].particles),
                  "Particles w, h along width (x) and height (y), w·h in all.")),
        fixed(row("cloth[].size", "m", positive_length, FIELD(model.cloths[i].size),
                  "Width and height of the undeformed cloth.")),
        START("cloth", cloths[i], "Center of the cloth at the start.",
              "Axis through the center, of any length, that turns the cloth out of the x–y plane.")},
       of(Belonging::explicit_springs,
          {row("cloth[].particle-mass", "kg", positive_mass, FIELD(model.cloths[i].particle_mass),
               "Mass m of each particle."),
           SPRINGS("cloth", "structural", cloths[i].structural, "between axis neighbors"),
           SPRINGS("cloth", "shear", cloths[i].shear, "along the diagonals of the cells"),
           SPRINGS("cloth", "bending", cloths[i].bending,
                   "between particles two steps apart along an axis")}),
       MATERIAL_ROWS("cloth", CLOTH_MATERIAL, "Density ρ, from which m = ρ·thickness·area/(w·h).",
                     "Young's modulus E of the sheet, whose Poisson's ratio is 1/3, along width and height."),
       of(Belonging::material, {row("cloth[].thickness", "m", positive_length,
                                    FIELD(model.cloths[i].thickness), "Thickness of the sheet.")}),
       {BODY_FRICTION("cloth", cloths[i]),
        fixed(
            pins("cloth", row("cloth[].pinned", FIELD(model.cloths[i].pinned),
                              "Particles that never move: edges, corners such as top-left, or local indices "
                              "i·h + j.")))}});
}

/// Cells of a file, which take the place of layers when the scene is read: no scene has the key.
Parameter cell_file() {
  Parameter p;
  p.path = "voxels[].file";
  p.type = ParameterType::text;
  p.live = false;
  p.when_absent = "none: the cells are here";
  p.meaning =
      "Cells from a .npy file, relative to the scene's: integers by x, y and z, 0 for empty, with names in "
      "`palette`, { 1 = \"muscle\" }. Instead of `layers`.";
  p.read = [](const Parameter&, const Scene&, std::size_t) { return std::optional<Value>(); };
  p.write = [](const Parameter&, Scene&, std::size_t, const Value&) {};
  return p;
}

/// A key of a mesh, which becomes layers and a skin when the scene is read: no scene has it.
Parameter mesh_key(std::string_view path, ParameterType type, std::string_view unit, const Range& range,
                   std::string_view meaning_of_absence, std::string_view meaning) {
  Parameter p = cell_file();
  p.path = path;
  p.type = type;
  p.unit = unit;
  p.range = range;
  p.when_absent = meaning_of_absence;
  p.meaning = meaning;
  return p;
}

Rows mesh_rows() {
  Parameter up = mesh_key("voxels[].up", ParameterType::word, "", {}, "y",
                          "Axis of the mesh's file that points upwards.");
  up.words = {"y", "z"};
  return {
      mesh_key("voxels[].mesh", ParameterType::text, "", {}, "none: the cells are here",
               "A mesh, .obj, .stl or .ply, relative to the scene's file, or the built-in rabbit: it is "
               "filled with cells and rendered as their skin. Instead of `layers` and `size`."),
      mesh_key("voxels[].cells", ParameterType::integer, "", {1, most_mesh_cells}, "24",
               "Cells along the longest edge of the mesh's box."),
      mesh_key("voxels[].height", ParameterType::number, "m", positive_length, "that of the file, in meters",
               "Height to which the mesh is scaled."),
      up,
  };
}

/// The skin, without what breaks a long text into lines.
Parameter skin_row() {
  Parameter p = fixed(
      unless_empty("the faces of the cells", "voxels[].skin", FIELD(model.voxels[i].skin),
                   "A mesh to render instead of the cells' faces; it moves with them. Made from `mesh`."));
  p.write = [](const Parameter&, Scene& scene, std::size_t i, const Value& value) {
    std::string text = std::get<std::string>(value);
    std::erase_if(text, [](char c) { return c == '\n' || c == '\r' || c == ' '; });
    scene.model.voxels[i].skin = std::move(text);
  };
  return p;
}

Rows voxel_rows() {
#define VOXEL_MATERIAL(field) FIELD(model.voxels[i].material.field)
  return joined(
      {{unless_empty("none", "voxels[].name", FIELD(model.voxels[i].name),
                     "Name of the body, unique among its kind."),
        fixed(row("voxels[].size", "m", positive_length, FIELD(model.voxels[i].size), "Edge of a cell.")),
        START("voxels", voxels[i], "Center of the layers at the start, including empty cells.",
              "Rotation axis through the center, of any length."),
        unless_empty("all cells are of `material`", "voxels[].palette", FIELD(model.voxels[i].palette),
                     "Maps each cell character to a [[material]].")},
       MATERIAL_ROWS("voxels", VOXEL_MATERIAL, "Density ρ of all cells.",
                     "Young's modulus E of all cells along an axis, from which k = E·s/7.3125."),
       {fixed(row("voxels[].layers", FIELD(model.voxels[i].layers),
                  "Cells, a character each: layers upwards (y), rows from back to front (z), left to right "
                  "(x); '.', '0' and ' ' are empty.")),
        cell_file()},
       mesh_rows(),
       {fixed(word<piece_choices>("voxels[].pieces", FIELD(model.voxels[i].pieces),
                                  "Cells that share no face with the others: refuse rejects the scene, "
                                  "largest keeps the largest piece, all keeps every piece.")),
        BODY_FRICTION("voxels", voxels[i]),
        fixed(pins("voxels", row("voxels[].pinned", FIELD(model.voxels[i].pinned),
                                 "Particles that never move: faces, corners such as left-top-front, or local "
                                 "indices."))),
        skin_row()}});
}

Rows ball_rows() {
  return {
      row("ball[].radius", "m", positive_length, FIELD(model.balls[i].radius), "Radius R."),
      row("ball[].mass", "kg", positive_mass, FIELD(model.balls[i].mass),
          "Mass m; the moment of inertia is 2/5·m·R² (a solid sphere)."),
      fixed(row("ball[].position", "m", within(far), FIELD(model.balls[i].position), "Center at the start.")),
      fixed(row("ball[].velocity", "m/s", within(divergence_speed), FIELD(model.balls[i].velocity),
                "Velocity at the start.")),
      fixed(row("ball[].angular-velocity", "rad/s", within(1e6), FIELD(model.balls[i].angular_velocity),
                "Angular velocity ω at the start.")),
  };
}

Rows launcher_rows() {
  Rows rows = {
      row("launcher[].seed", "", {0, 1e15}, FIELD(model.launchers[i].seed),
          "Seed of the random sequence: the same seed throws the same balls."),
      row("launcher[].count", "", {0, 10000000}, FIELD(model.launchers[i].count),
          "Number of balls to throw."),
      row("launcher[].interval", "s", {0.0, longest}, FIELD(model.launchers[i].interval),
          "Time between two balls; the first comes at the start."),
      row("launcher[].from.min", "m", within(far), FIELD(model.launchers[i].from.min),
          "Lower corner of the box of starting points."),
      row("launcher[].from.max", "m", within(far), FIELD(model.launchers[i].from.max),
          "Upper corner of that box."),
      row("launcher[].towards.min", "m", within(far), FIELD(model.launchers[i].towards.min),
          "Lower corner of the box of targets."),
      row("launcher[].towards.max", "m", within(far), FIELD(model.launchers[i].towards.max),
          "Upper corner of that box."),
      row("launcher[].speed-factor", "1/s", {0.0, 1e6}, FIELD(model.launchers[i].speed_factor),
          "Velocity per distance from start to target."),
      row("launcher[].ball.radius", "m", positive_length, FIELD(model.launchers[i].ball.radius),
          "Radius of the balls."),
      row("launcher[].ball.mass", "kg", positive_mass, FIELD(model.launchers[i].ball.mass),
          "Mass of the balls."),
  };
  for (Parameter& p : rows) p.live = false;
  return rows;
}

}  // namespace

std::vector<Parameter> material_parameters() {
  return {
      unless_empty("no body can use it", "material[].name", FIELD(model.materials[i].name),
                   "Name for use in bodies."),
      row("material[].density", "kg/m³", positive_mass, FIELD(model.materials[i].density), "Density ρ."),
      row("material[].youngs-modulus", "Pa", {0.0, stiffest, true}, FIELD(model.materials[i].youngs_modulus),
          "Young's modulus E."),
      row("material[].damping-ratio", "", {0.0, 1e6}, FIELD(model.materials[i].damping_ratio),
          "Damping ratio ζ."),
  };
}

std::vector<Parameter> body_parameters() {
  return joined({cube_rows(), voxel_rows(), net_rows(), cloth_rows(), ball_rows(), launcher_rows()});
}

}  // namespace aspic
