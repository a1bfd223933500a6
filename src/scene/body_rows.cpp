#include "model/bodies.h"
#include "model/solver.h"
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

std::vector<Parameter> cube_rows() {
  return {
      fixed(row("cube[].particles-per-edge", "", {2, 512}, FIELD(model.cubes[i].particles_per_edge),
                "Particles n along each edge, n³ in all.")),
      fixed(row("cube[].edge-length", "m", positive_length, FIELD(model.cubes[i].edge_length),
                "Edge of the undeformed cube.")),
      fixed(row("cube[].position", "m", within(far), FIELD(model.cubes[i].position),
                "Centre of the cube at the start.")),
      fixed(direction(row("cube[].rotation.axis", FIELD(model.cubes[i].rotation.axis),
                          "Rotation axis through the centre; its length does not matter."))),
      fixed(row("cube[].rotation.angle", "°", {-36000.0, 36000.0}, FIELD(model.cubes[i].rotation.angle),
                "Rotation angle, right-handed.")),
      fixed(row("cube[].velocity", "m/s", within(divergence_speed), FIELD(model.cubes[i].velocity),
                "Initial velocity of the particles that are not pinned.")),
      of(springs, row("cube[].particle-mass", "kg", {0.0, heaviest, true},
                      FIELD(model.cubes[i].particle_mass), "Mass m of each particle.")),
      of(springs,
         row("cube[].structural.stiffness", "N/m", stiffness, FIELD(model.cubes[i].structural.stiffness),
             "Stiffness k of the springs between axis neighbours.")),
      of(springs, row("cube[].structural.damping", "N·s/m", damping, FIELD(model.cubes[i].structural.damping),
                      "Damping c of the springs between axis neighbours.")),
      of(springs, row("cube[].shear.stiffness", "N/m", stiffness, FIELD(model.cubes[i].shear.stiffness),
                      "Stiffness k of the springs along face and body diagonals.")),
      of(springs, row("cube[].shear.damping", "N·s/m", damping, FIELD(model.cubes[i].shear.damping),
                      "Damping c of the springs along face and body diagonals.")),
      of(springs, row("cube[].bending.stiffness", "N/m", stiffness, FIELD(model.cubes[i].bending.stiffness),
                      "Stiffness k of the springs between particles two steps apart along an axis.")),
      of(springs, row("cube[].bending.damping", "N·s/m", damping, FIELD(model.cubes[i].bending.damping),
                      "Damping c of the springs between particles two steps apart along an axis.")),
      of(material, row("cube[].material.density", "kg/m³", {0.0, heaviest, true}, MATERIAL(density),
                       "Density ρ, from which m = ρ·edge³/n³.")),
      of(material,
         row("cube[].material.youngs-modulus", "Pa", {0.0, stiffest, true}, MATERIAL(youngs_modulus),
             "Young's modulus E along an axis, from which k = E·s/7.3125 at spacing s.")),
      of(material, row("cube[].material.damping-ratio", "", {0.0, 1e6}, MATERIAL(damping_ratio),
                       "Damping ratio ζ, from which c = 2ζ√(k·m/2).")),
      fixed(pins("cube", row("cube[].pinned", FIELD(model.cubes[i].pinned),
                             "Particles that never move: faces, corners such as left-top-front, or local "
                             "indices."))),
  };
}

std::vector<Parameter> net_rows() {
  return {
      fixed(row("goal-net[].particles", "", {2, 512}, FIELD(model.goal_nets[i].particles),
                "Lattice points nw, nh, nl along width (x), height (y) and length (z).")),
      fixed(row("goal-net[].size", "m", positive_length, FIELD(model.goal_nets[i].size),
                "Width, height and length; the front, towards +x, and the bottom are open.")),
      fixed(row("goal-net[].position", "m", within(far), FIELD(model.goal_nets[i].position),
                "Centre of the box.")),
      row("goal-net[].particle-mass", "kg", {0.0, heaviest, true}, FIELD(model.goal_nets[i].particle_mass),
          "Mass m of each particle."),
      row("goal-net[].structural.stiffness", "N/m", stiffness, FIELD(model.goal_nets[i].structural.stiffness),
          "Stiffness k of the springs between axis neighbours."),
      row("goal-net[].structural.damping", "N·s/m", damping, FIELD(model.goal_nets[i].structural.damping),
          "Damping c of the springs between axis neighbours."),
      fixed(row("goal-net[].shear.stiffness", "N/m", stiffness, FIELD(model.goal_nets[i].shear.stiffness),
                "Stiffness k of the springs along the diagonals of the faces' cells; 0: there are none.")),
      row("goal-net[].shear.damping", "N·s/m", damping, FIELD(model.goal_nets[i].shear.damping),
          "Damping c of the springs along face diagonals."),
      fixed(
          row("goal-net[].bending.stiffness", "N/m", stiffness, FIELD(model.goal_nets[i].bending.stiffness),
              "Stiffness k of the springs between particles two steps apart in a face; 0: there are none.")),
      row("goal-net[].bending.damping", "N·s/m", damping, FIELD(model.goal_nets[i].bending.damping),
          "Damping c of the springs between particles two steps apart."),
      row("goal-net[].cord", FIELD(model.goal_nets[i].cord),
          "Whether its springs resist stretch only, like a cord."),
  };
}

std::vector<Parameter> cloth_rows() {
  return {
      fixed(row("cloth[].particles", "", {2, 512}, FIELD(model.cloths[i].particles),
                "Particles w, h along width (x) and height (y), w·h in all.")),
      fixed(row("cloth[].size", "m", positive_length, FIELD(model.cloths[i].size),
                "Width and height of the undeformed cloth.")),
      fixed(row("cloth[].position", "m", within(far), FIELD(model.cloths[i].position),
                "Centre of the cloth at the start.")),
      fixed(direction(
          row("cloth[].rotation.axis", FIELD(model.cloths[i].rotation.axis),
              "Axis through the centre about which the cloth is turned out of the x–y plane; its length does "
              "not matter."))),
      fixed(row("cloth[].rotation.angle", "°", {-36000.0, 36000.0}, FIELD(model.cloths[i].rotation.angle),
                "Rotation angle, right-handed.")),
      fixed(row("cloth[].velocity", "m/s", within(divergence_speed), FIELD(model.cloths[i].velocity),
                "Initial velocity of the particles that are not pinned.")),
      row("cloth[].particle-mass", "kg", {0.0, heaviest, true}, FIELD(model.cloths[i].particle_mass),
          "Mass m of each particle."),
      row("cloth[].structural.stiffness", "N/m", stiffness, FIELD(model.cloths[i].structural.stiffness),
          "Stiffness k of the springs between axis neighbours."),
      row("cloth[].structural.damping", "N·s/m", damping, FIELD(model.cloths[i].structural.damping),
          "Damping c of the springs between axis neighbours."),
      row("cloth[].shear.stiffness", "N/m", stiffness, FIELD(model.cloths[i].shear.stiffness),
          "Stiffness k of the springs along the diagonals of the cells."),
      row("cloth[].shear.damping", "N·s/m", damping, FIELD(model.cloths[i].shear.damping),
          "Damping c of the springs along the diagonals of the cells."),
      row("cloth[].bending.stiffness", "N/m", stiffness, FIELD(model.cloths[i].bending.stiffness),
          "Stiffness k of the springs between particles two steps apart along an axis."),
      row("cloth[].bending.damping", "N·s/m", damping, FIELD(model.cloths[i].bending.damping),
          "Damping c of the springs between particles two steps apart along an axis."),
      fixed(pins("cloth", row("cloth[].pinned", FIELD(model.cloths[i].pinned),
                              "Particles that never move: edges, corners such as top-left, or local indices "
                              "i·h + j."))),
  };
}

std::vector<Parameter> ball_rows() {
  return {
      row("ball[].radius", "m", positive_length, FIELD(model.balls[i].radius), "Radius R."),
      row("ball[].mass", "kg", {0.0, heaviest, true}, FIELD(model.balls[i].mass),
          "Mass m; its moment of inertia is 2/5·m·R², a solid sphere's."),
      fixed(row("ball[].position", "m", within(far), FIELD(model.balls[i].position), "Centre at the start.")),
      fixed(row("ball[].velocity", "m/s", within(divergence_speed), FIELD(model.balls[i].velocity),
                "Velocity at the start.")),
      fixed(row("ball[].angular-velocity", "rad/s", within(1e6), FIELD(model.balls[i].angular_velocity),
                "Angular velocity ω at the start.")),
  };
}

std::vector<Parameter> launcher_rows() {
  return {
      fixed(row("launcher[].seed", "", {0, 1e15}, FIELD(model.launchers[i].seed),
                "Seed of the random sequence: the same seed throws the same balls.")),
      fixed(row("launcher[].count", "", {0, 10000000}, FIELD(model.launchers[i].count),
                "Number of balls it throws.")),
      fixed(row("launcher[].interval", "s", {0.0, longest}, FIELD(model.launchers[i].interval),
                "Time between two balls; the first comes at the start.")),
      fixed(row("launcher[].from.min", "m", within(far), FIELD(model.launchers[i].from.min),
                "Lower corner of the box of starting points.")),
      fixed(row("launcher[].from.max", "m", within(far), FIELD(model.launchers[i].from.max),
                "Upper corner of that box.")),
      fixed(row("launcher[].towards.min", "m", within(far), FIELD(model.launchers[i].towards.min),
                "Lower corner of the box of targets.")),
      fixed(row("launcher[].towards.max", "m", within(far), FIELD(model.launchers[i].towards.max),
                "Upper corner of that box.")),
      fixed(row("launcher[].speed-factor", "1/s", {0.0, 1e6}, FIELD(model.launchers[i].speed_factor),
                "Velocity per distance from start to target.")),
      fixed(row("launcher[].ball.radius", "m", positive_length, FIELD(model.launchers[i].ball.radius),
                "Radius of its balls.")),
      fixed(row("launcher[].ball.mass", "kg", {0.0, heaviest, true}, FIELD(model.launchers[i].ball.mass),
                "Mass of its balls.")),
  };
}

}  // namespace

std::vector<Parameter> body_parameters() {
  std::vector<Parameter> all;
  for (auto part : {cube_rows(), net_rows(), cloth_rows(), ball_rows(), launcher_rows()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace aspic
