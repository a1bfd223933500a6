// Balls on coarse faces of bodies: rest, momentum and energy, and that none passes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/analysis.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

/// A cube of eight particles, 1 m along an edge.
CubeSettings coarse_body(const Vec3& center) {
  CubeSettings cube;
  cube.particles_per_edge = 2;
  cube.edge_length = 1.0;
  cube.position = center;
  cube.particle_mass = 5.0;
  cube.structural = cube.shear = cube.bending = {4000.0, 60.0};
  return cube;
}

/// A ball dropped on a cube that stands on its bottom, 7 s later.
Result<State> ball_dropped(const Subject& subject, Integrator integrator, bool held, const Vec3& from) {
  ModelSettings settings;
  settings.simulation.integrator = integrator;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 1.0 / 240.0;
  settings.contact.ball_restitution = 0.3;
  settings.cubes = {coarse_body({0.0, 0.5, 0.0})};
  settings.cubes[0].pinned.names = {"bottom"};
  if (held) settings.cubes[0].pinned.names.push_back("top");
  settings.balls.push_back({0.2, 2.0, from, {}, {}});
  ASPIC_TRY(auto model, build_model(settings));
  return run_reference(subject, model, Precision::double_, steps_of(model, 7.0));
}

/// On a face that does not give way it stands still; on one that does it may rock in the dent.
Result<Finding> rests_on_faces(const Subject& subject, Integrator integrator) {
  ASPIC_TRY(auto held, ball_dropped(subject, integrator, true, {0.13, 1.5, -0.21}));
  ASPIC_TRY(auto free, ball_dropped(subject, integrator, false, {0.0, 1.5, 0.0}));
  const double speed = length(held.ball_velocity[0]), off = std::abs(held.ball_position[0].y - 1.2),
               sinks = std::abs(free.ball_velocity[0].y), rocks = length(free.ball_velocity[0]);
  const bool stays = std::abs(free.ball_position[0].y - 1.2) < 0.05;
  return Finding{speed <= 1e-9 && off <= 0.01 && sinks <= 1e-4 && rocks <= 1e-2 && stays,
                 fmt::format("{:.2g} m/s, {:.2g} m; {:.2g}, {:.2g} m/s", speed, off, sinks, rocks)};
}

/// A cube alone in space, and balls that fly at it from everywhere.
ModelSettings bombarded(double speed, std::uint64_t seed) {
  Noise noise(seed);
  ModelSettings settings;
  settings.simulation.integrator = Integrator::symplectic_euler;
  settings.simulation.gravity = {};
  settings.cubes = {coarse_body({})};
  settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  for (int b = 0; b < 6; ++b) {
    const Vec3 from = noise.vector(), aim = 0.25 * noise.vector();
    const Vec3 at = ((1.6 + 0.5 * b) / length(from)) * from;
    const Vec3 v = (speed / length(aim - at)) * (aim - at);
    settings.balls.push_back({0.15, 0.5, at, v, 9.0 * noise.vector()});
  }
  return settings;
}

struct Sums {
  Vec3 momentum;
  double size = 0.0;  ///< Σ m·|v|
};
Sums ball_sums(const Model& model, const State& state) {
  Sums sums;
  const auto add = [&](double m, const Vec3& v) {
    sums.momentum = sums.momentum + m * v;
    sums.size += m * length(v);
  };
  for (std::size_t i = 0; i < state.velocity.size(); ++i) add(model.mass[i], state.velocity[i]);
  for (std::size_t b = 0; b < state.ball_velocity.size(); ++b)
    add(model.balls[b].mass, state.ball_velocity[b]);
  return sums;
}

Result<Finding> balls_keep_momentum(const Subject& subject) {
  double worst = 0.0, gained = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    ASPIC_TRY(auto model, build_model(bombarded(6.0, seed)));
    const State start = initial_state(model, Precision::double_);
    const Sums before = ball_sums(model, start);
    const double energy = measure(model, start).total();
    ASPIC_TRY(auto end, run_reference(subject, model, Precision::double_, 1200));
    worst = std::max(worst, length(ball_sums(model, end).momentum - before.momentum) / before.size);
    gained = std::max(gained, measure(model, end).total() / energy - 1.0);
  }
  return Finding{worst <= 1e-12 && gained <= 0.0,
                 fmt::format("{:.2g}; {}", worst, gained > 0.0 ? fmt::format("{:.2g}", gained) : "none")};
}

Result<Finding> no_ball_passes(const Subject& subject) {
  double nearest = 1e9;
  for (const double speed : {5.0, 20.0, 60.0, 120.0}) {
    for (std::uint64_t seed = 11; seed <= 16; ++seed) {
      ModelSettings settings = bombarded(speed, seed);
      for (int i = 0; i < 8; ++i) settings.cubes[0].pinned.indices.push_back(i);
      ASPIC_TRY(auto model, build_model(settings));
      ASPIC_TRY(auto solver, subject.reference(model, Precision::double_));
      for (int n = 0; n < 400; ++n) {
        ASPIC_TRY(auto now, run(*solver, 2));
        for (const Vec3& x : now.ball_position) nearest = std::min(nearest, length(x));
      }
    }
  }
  return Finding{nearest > 0.5, fmt::format("{:.3g} m", nearest)};
}

}  // namespace

void add_ball_face_checks(std::vector<Check>& checks) {
  for (const Integrator integrator : all_integrators) {
    checks.push_back(
        {fmt::format("bodies/balls/rest/{}", name_of(integrator)),
         "a ball dropped on a cube of 2³, none of whose particles it touches, 7 s later: on a held "
         "face its speed and how far it is from it, on a soft one its speed up or down, and in all",
         "≤ 1e-09 m/s, ε; 0.0001, 0.01 m/s", false, false,
         [=](const Subject& subject) { return rests_on_faces(subject, integrator); }});
  }
  checks.push_back(
      {"bodies/balls/momentum",
       "six spinning balls thrown at a free cube of 2³, eight times: momentum lost, of Σ m·abs(v); energy "
       "gained",
       "≤ 1e-12; none", false, false, balls_keep_momentum});
  checks.push_back(
      {"bodies/balls/passing",
       "balls of 0.15 m thrown at a held cube of 2³, 1 m along an edge, at 5 to 120 m/s: nearest to its "
       "middle",
       "> 0.5 m", false, false, no_ball_passes});
}

}  // namespace aspic::verify
