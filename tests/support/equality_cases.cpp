#include "support/equality_cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "model/springs.h"
#include "model/terrain.h"
#include "support/covering.h"
#include "support/model_building.h"

namespace aspic::test {
namespace {

constexpr std::array all_bodies = {Bodies::cube, Bodies::listed_cube, Bodies::cloth,  Bodies::cube_and_balls,
                                   Bodies::all,  Bodies::box,         Bodies::voxels, Bodies::robot};
constexpr std::array all_grounds = {Ground::bouncing, Ground::holding, Ground::moving};
/// Particles that an invocation of the lattice kernel takes: as software likes it, and as hardware does.
constexpr std::array<std::uint32_t, 2> all_runs = {0, 1};

std::string_view word_of(Bodies bodies) {
  switch (bodies) {
    case Bodies::cube:
      return "a cube";
    case Bodies::listed_cube:
      return "a cube of listed springs";
    case Bodies::cloth:
      return "a cloth";
    case Bodies::cube_and_balls:
      return "a cube and balls";
    case Bodies::box:
      return "a box";
    case Bodies::voxels:
      return "a body of cells";
    case Bodies::robot:
      return "a robot";
    case Bodies::all:
      break;
  }
  return "all bodies";
}

std::string_view word_of(Ground ground) {
  switch (ground) {
    case Ground::bouncing:
      return "";
    case Ground::holding:
      return " that holds";
    case Ground::moving:
      break;
  }
  return " that moves";
}

CubeSettings cube(int particles_per_edge, double edge, const Vec3& position) {
  CubeSettings settings;
  settings.particles_per_edge = particles_per_edge;
  settings.edge_length = edge;
  settings.position = position;
  settings.rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.velocity = {1.0, -2.0, 0.5};
  return settings;
}

void add_net(ModelSettings& settings, const Vec3& position) {
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  net.particles = {4, 5, 6};
  net.size = {1.0, 1.2, 1.6};
  net.position = position;
  net.shear = net.bending = {300.0, 10.0};
  net.cord = true;
}

void add_cloth(ModelSettings& settings, const Vec3& position) {
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {10, 7};
  cloth.size = {1.5, 1.0};
  cloth.position = position;
  cloth.rotation = {{1.0, 0.2, 0.1}, 70.0};
  cloth.velocity = {0.3, -2.0, 0.2};
}

void add_balls(ModelSettings& settings, const Vec3& position) {
  settings.balls.push_back({0.4, 3.0, position, {0.2, -4.0, 0.1}, {0.0, 0.0, 6.0}});
  settings.balls.push_back({0.3, 1.0, position + Vec3{0.1, 0.75, 0.2}, {0.0, -5.0, 0.0}, {}});
  LauncherSettings& launcher = settings.launchers.emplace_back();
  launcher.count = 3;
  launcher.interval = 0.02;
  launcher.from = {position + Vec3{-0.5, 1.5, -0.5}, position + Vec3{0.5, 1.7, 0.5}};
  launcher.towards = {position + Vec3{-0.3, 0.0, -0.3}, position + Vec3{0.3, 0.0, 0.3}};
  launcher.speed_factor = 9.0;
  launcher.ball = {0.2, 0.5};
}

/// Two materials, a hole, a hinge and a piece apart.
void add_voxels(ModelSettings& settings, const Vec3& position) {
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.7;
  voxels.position = position;
  voxels.rotation = {{1.0, 0.3, 0.7}, 25.0};
  voxels.velocity = {1.0, -2.0, 0.5};
  voxels.layers = {{"11221", "1.2.1", "11221"}, {"2....", ".1..2", "....2"}};
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.pieces = Pieces::all;
}

/// A wave of one material's cells, springs of these and others that a table pulls along an axis, and cells of
/// the other material that wait for an input.
void add_actuators(ModelSettings& settings) {
  ActuatorSettings& wave = settings.actuators.emplace_back();
  wave.select.materials = {"jelly"};
  wave.volume_change = 0.4;
  wave.frequency = 3.0;
  wave.phase = {0.1, BodyAxis::x, 1.7, {}};
  wave.ramp = 0.05;
  ActuatorSettings& pull = settings.actuators.emplace_back();
  pull.select.springs = {"structural", "bending"};
  pull.axis = BodyAxis::y;
  pull.amplitude = 0.15;
  pull.signal = Signal::table;
  pull.table = {{0.0, -0.5}, {0.3, 1.0}, {0.3, 0.0}, {1.0, -0.5}};
  pull.frequency = 2.0;
  ActuatorSettings& hand = settings.actuators.emplace_back();
  hand.select.materials = {"fat"};
  hand.amplitude = -0.2;
  hand.signal = Signal::input;
}

void add_bodies(ModelSettings& settings, Bodies bodies, const Vec3& at) {
  switch (bodies) {
    case Bodies::cube:
      settings.cubes.push_back(cube(5, 4.0, at));
      break;
    case Bodies::listed_cube:
      settings.cubes.push_back(cube(4, 4.0, at));
      break;
    case Bodies::cloth:
      add_cloth(settings, at);
      break;
    case Bodies::cube_and_balls:
      settings.cubes.push_back(cube(4, 3.0, at));
      add_balls(settings, at + Vec3{0.0, 2.9, 0.0});
      break;
    case Bodies::box:
      settings.cubes.push_back(cube(2, 3.5, at));
      settings.cubes[0].particles = {3, 7, 5};
      break;
    case Bodies::voxels:
      add_voxels(settings, at);
      break;
    case Bodies::robot:
      add_voxels(settings, at);
      add_actuators(settings);
      break;
    case Bodies::all:
      settings.cubes = {cube(4, 1.6, at), cube(3, 1.0, at + Vec3{0.2, 1.5, 0.0})};
      add_net(settings, at + Vec3{0.0, 0.2, -1.9});
      add_cloth(settings, at + Vec3{0.0, 0.0, 1.6});
      add_balls(settings, at + Vec3{0.2, 3.1, 0.0});
      break;
  }
}

void move(ModelSettings& settings, const Vec3& by) {
  for (auto& each : settings.cubes) each.position = each.position + by;
  for (auto& each : settings.voxels) each.position = each.position + by;
  for (auto& each : settings.goal_nets) each.position = each.position + by;
  for (auto& each : settings.cloths) each.position = each.position + by;
  for (auto& each : settings.balls) each.position = each.position + by;
  for (auto& each : settings.launchers) {
    for (Vec3* const corner : {&each.from.min, &each.from.max, &each.towards.min, &each.towards.max})
      *corner = *corner + by;
  }
}

double nearest(const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  for (const Terrain& rest : model.terrain) {
    const Terrain terrain = terrain_at(rest, model.simulation.timestep, 0);
    for (const Vec3& x : model.initial_position) least = std::min(least, signed_distance(terrain, x));
    for (const Ball& ball : model.balls) {
      if (ball.launched(0))
        least = std::min(least, signed_distance(terrain, ball.initial_position) - ball.radius);
    }
  }
  return least;
}

}  // namespace

const std::vector<EqualityCase>& covering_cases() {
  static const std::vector<EqualityCase> cases = [] {
    // Contact model and ground are one factor, so that every terrain has all six of them.
    const std::size_t contacts = std::size(contact_models);
    const std::array sizes = {
        all_integrators.size(), std::size(terrain_shapes), contacts * all_grounds.size(),
        force_paths().size(),   all_bodies.size(),         all_runs.size()};
    const auto allowed = [](const CoveringRow& row) {
      return works_with(force_paths()[row[3]].path, all_integrators[row[0]]);
    };
    std::vector<EqualityCase> result;
    // Those with the bodies that were there before others come first, as the file of known hashes has them.
    std::vector<CoveringRow> rows;
    for (const Bodies later : {Bodies::box, Bodies::voxels, Bodies::robot}) {
      std::array without = sizes;
      without[4] = static_cast<std::size_t>(later);
      rows = cover_pairs(without, allowed, std::move(rows));
    }
    for (const CoveringRow& row : cover_pairs(sizes, allowed, std::move(rows))) {
      result.push_back({all_integrators[row[0]], terrain_shapes[row[1]].value,
                        contact_models[row[2] % contacts].value, force_paths()[row[3]].path,
                        all_bodies[row[4]], all_grounds[row[2] / contacts], all_runs[row[5]]});
    }
    return result;
  }();
  return cases;
}

std::string scene_of(const EqualityCase& row) {
  return fmt::format("{} on a {}{}, {}", word_of(row.bodies), terrain_row(row.shape).name,
                     word_of(row.ground), name_of(row.contact));
}

std::string text_of(const EqualityCase& row) {
  return fmt::format("{}, {}, path {}, lattice run {}", scene_of(row), name_of(row.integrator),
                     name_of(row.path), row.lattice_run);
}

ModelSettings settings_of(const EqualityCase& row) {
  ModelSettings settings;
  settings.simulation.integrator = row.integrator;
  if (const MethodTraits& traits = row_of(row.integrator).traits; traits.stable_at_any_step)
    settings.simulation.timestep = traits.nominal_step;
  settings.contact.model = row.contact;
  TerrainSettings& terrain = settings.terrain.emplace_back();
  terrain.shape = row.shape;
  if (row.ground == Ground::holding) {
    terrain.restitution = 0.1;
    terrain.friction = 1.2;
    terrain.mass = 30.0;
  } else if (row.ground == Ground::moving) {
    terrain.restitution = 0.3;
    terrain.motion = TerrainMotion{{0.5, 1.0, 0.2}, 0.2, 0.9, 0.6};
  }
  // A cloth would fall through the ring: it lands on its tube.
  const bool through =
      (row.bodies == Bodies::cloth || row.bodies == Bodies::all) && row.shape == TerrainShape::torus;
  const Vec3 aside = {through ? 3.0 : 0.0, 0.0, 0.0};
  add_bodies(settings, row.bodies, terrain_row(row.shape).drop + aside);
  set_down(settings, 0.01);
  return settings;
}

Model model_of(const EqualityCase& row) {
  Model model = build(settings_of(row));
  if (row.bodies == Bodies::listed_cube) list_springs(model);
  return model;
}

std::uint64_t steps_of(const EqualityCase& row) {
  const bool rests = row.ground == Ground::holding;
  if (row_of(row.integrator).traits.long_steps) return rests ? 40 : 20;
  // Bodies that touch take longest, and do so from the start.
  if (row.bodies == Bodies::all) return rests ? 200 : 150;
  // Of the course model friction acts late.
  if (row.contact == ContactModel::coulomb) return rests ? 200 : 180;
  return rests ? 300 : 250;
}

void set_down(ModelSettings& settings, double gap) {
  // A distance never grows faster than one moves: no step reaches too far.
  for (int n = 0; n < 100; ++n) {
    const double lower = nearest(build(settings)) - gap;
    if (!(std::abs(lower) > 1e-3) || std::isinf(lower)) return;
    move(settings, {0.0, -lower, 0.0});
  }
}

}  // namespace aspic::test
