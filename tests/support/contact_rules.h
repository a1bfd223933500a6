#pragma once
// Two rules of contact that keep rounding from deciding, as scenes that any solver can run.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "aspic/inputs.h"
#include "aspic/solver.h"
#include "model/terrain.h"
#include "support/model_building.h"

namespace aspic::test {

/// A particle about to meet a plane of this normal at 3 m/s, which gives nothing back: e = 0. A pull takes 1
/// m/s off it within the step, so that the position of explicit Euler lags behind its velocity by 0.5 m/s.
inline Model landing_without_bounce(const Vec3& normal) {
  const Vec3 n = 1.0 / length(normal) * normal;
  Model model = particles({0.001 * n}, {-3.0 * n});
  model.bodies.resize(1);  // the cpu solver moves particles body by body
  model.bodies[0].particle_count = 1;
  TerrainSettings plane;
  plane.geometry["point"] = Vec3{};
  plane.geometry["normal"] = normal;
  plane.restitution = 0.0;
  plane.friction = 0.0;
  model.terrain = {make_terrain(plane, ContactSettings{})};
  return model;
}

/// Whatever the ground's normal, the particle leaves the step at |g|h, well below v_rest = 2|g|h.
/// `make(model)`: a solver of explicit Euler.
template <class Make>
void expect_landing_to_rest(const Make& make) {
  for (int k = 0; k < 12; ++k) {
    const Vec3 normal = {0.1 * k - 0.5, 1.0, 0.07 * k};
    const Vec3 n = 1.0 / length(normal) * normal;
    const Model model = landing_without_bounce(normal);
    const double fall = length(model.simulation.gravity) * model.simulation.timestep;
    const std::unique_ptr<Solver> solver = make(model);
    Pull pull;
    pull.particle = 0;
    pull.anchor = 1.001 * n;
    pull.stiffness = 1000.0;
    ASSERT_TRUE(solver->set_inputs(inputs_of(pull)).ok());
    ASSERT_FALSE((*solver->advance(1)).divergence.has_value());
    const State state = *solver->state();
    EXPECT_NEAR(dot(state.velocity[0], n), fall, 1e-6) << "normal " << k;
  }
}

/// A cube set down on a slope of 15° under implicit Euler. The slope is made of planes with these frictions,
/// in this order, each through another point of it.
template <std::size_t N>
Model cube_on_slope(const std::array<double, N>& frictions) {
  constexpr double angle = 15.0 * 3.14159265358979323846 / 180.0;
  const Vec3 n = {std::sin(angle), std::cos(angle), 0.0}, along = {std::cos(angle), -std::sin(angle), 0.0};
  ModelSettings settings = cube_on_plane(3);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = 1.0 / 60.0;
  settings.cubes[0].position = 2.0 * n;
  settings.cubes[0].rotation = {{0.0, 0.0, 1.0}, -15.0};
  settings.terrain.clear();
  for (const double friction : frictions) {
    const double shift = 0.37 * static_cast<double>(settings.terrain.size());
    settings.terrain.push_back({.geometry = {{"point", shift * along}, {"normal", (1.0 + shift) * n}}});
    settings.terrain.back().friction = friction;
  }
  return build(settings);
}

/// A cube that lands, with the default contact thresholds, another distance, and another resting speed.
inline std::array<Model, 3> landings(ContactModel contact) {
  ModelSettings settings = cube_on_plane(4, 1.05);
  settings.cubes[0].velocity = {0.2, 0.0, 0.1};
  settings.contact.model = contact;
  ModelSettings farther = settings, faster = settings;
  farther.contact.distance = 0.1;
  faster.contact.resting_speed = 1.0;
  return {build(settings), build(farther), build(faster)};
}

/// The center of the particles [m].
inline Vec3 center_of(const State& state) {
  Vec3 sum;
  for (const Vec3& x : state.position) sum = sum + x;
  return 1.0 / static_cast<double>(state.position.size()) * sum;
}

/// Of planes that lie in one, the one with more friction holds: the cube sticks as on that one alone, where
/// without friction it would slide 1.2 m in a second. `make(model)`: a solver.
template <class Make>
void expect_more_friction_to_hold(const Make& make) {
  const auto center_after = [&](const Model& model) {
    const std::unique_ptr<Solver> solver = make(model);
    EXPECT_FALSE((*solver->advance(60)).divergence.has_value());
    return center_of(*solver->state());
  };
  const Vec3 alone = center_after(cube_on_slope(std::array{0.5}));
  EXPECT_LE(length(center_after(cube_on_slope(std::array{0.0, 0.5})) - alone), 1e-3);
  EXPECT_LE(length(center_after(cube_on_slope(std::array{0.5, 0.0})) - alone), 1e-3);
  EXPECT_LE(length(center_after(cube_on_slope(std::array{0.1, 0.0, 0.5, 0.2})) - alone), 1e-3);
}

}  // namespace aspic::test
