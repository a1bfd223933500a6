// Bodies come to rest under implicit Euler, with the ground in its equation, at 60 steps a second: cubes,
// slopes, grooves and corners, sphere and bowl, pinned particles. The explicit
// methods' are in rest_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/analysis.h"
#include "model/terrain.h"
#include "support/epsilon.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::advanced;
using test::fastest;
using test::layer;
using test::solver_for;

using test::eps;
constexpr double h = 1.0 / 60.0, g = 9.8;
constexpr double tolerance = 1e-9;  // of a solve in double precision [m/s]

TerrainSettings plane(const Vec3& point, const Vec3& normal) {
  TerrainSettings settings;
  settings.geometry["point"] = point;
  settings.geometry["normal"] = normal;
  return settings;
}

ModelSettings cube(int n, const Vec3& position) {
  ModelSettings settings = test::cube_on_plane(n);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = h;
  settings.cubes[0].position = position;
  return settings;
}

ModelSettings cube_on_slope(double degrees, double mu, double gap) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const Vec3 n = {std::sin(angle), std::cos(angle), 0.0};
  ModelSettings settings = cube(5, (2.0 + gap) * n);
  settings.cubes[0].rotation = {{0.0, 0.0, 1.0}, -degrees};
  settings.terrain = {plane({}, n)};
  settings.terrain[0].friction = mu;
  return settings;
}

Model loose(std::vector<Vec3> positions, const std::vector<Vec3>& velocities,
            std::vector<TerrainSettings> terrain, const ContactSettings& contact = {}) {
  Model model = test::particles(std::move(positions), velocities);
  model.simulation.integrator = Integrator::implicit_euler;
  model.simulation.timestep = h;
  model.contact = contact;
  for (const TerrainSettings& t : terrain) model.terrain.push_back(make_terrain(t, contact));
  return model;
}

// A step that ends at its tolerance τ may leave an energy of at most Σ m·|v|·√3·τ per particle too much.
TEST(ImplicitRest, TheDefaultCubeFallsComesToRestAndGainsNoEnergy) {
  const Model model = test::build(cube(10, {0.0, 9.0, 0.0}));
  const auto solver = solver_for(model);
  double before = measure(model, *solver->state()).total();
  for (int n = 0; n < 600; ++n) {
    const Measures now = measure(model, advanced(*solver, 1));
    EXPECT_LE(now.total(), before + 1000 * (20.0 * std::sqrt(3.0) * tolerance) + 1e4 * 1000 * eps) << n;
    before = now.total();
  }
  const State end = *solver->state();
  EXPECT_LT(fastest(end), 1e-6);
  EXPECT_LT(layer(model.terrain[0], end, 100), 1e-5);
  const SolveStatistics all = *solver->solve_statistics();
  EXPECT_EQ(all.converged, 600u);
  const auto single = solver_for(model, Precision::single);
  const State rough = advanced(*single, 600);
  EXPECT_LT(fastest(rough), 1e-3);
  EXPECT_LT(layer(model.terrain[0], rough, 100), 1e-5);
  EXPECT_EQ(single->solve_statistics()->converged, 600u);
}

TEST(ImplicitRest, TurnedCubes) {
  for (const RotationSettings& turn : {RotationSettings{{1.0, 0.0, 1.0}, 30.0}, {{1.0, 0.3, 0.2}, 50.0}}) {
    ModelSettings settings = cube(5, {0.0, 4.0, 0.0});
    settings.cubes[0].rotation = turn;
    const Model model = test::build(settings);
    const auto solver = solver_for(model);
    const State end = advanced(*solver, 600);
    EXPECT_LT(fastest(end), 1e-6);
    EXPECT_GE(solver->solve_statistics()->converged, 595u);
    const double start = measure(model, initial_state(model, Precision::double_)).total();
    EXPECT_LT(measure(model, end).total(), start);
  }
}

// The cone holds it: μ = 0.5 > tan 15° = 0.268.
TEST(ImplicitRest, ACubeOnASlopeItSticksTo) {
  const Model model = test::build(cube_on_slope(15.0, 0.5, 0.5));
  const auto solver = solver_for(model);
  const State early = advanced(*solver, 420), late = advanced(*solver, 60);
  EXPECT_LT(fastest(late), 1e-6);
  EXPECT_LT(layer(model.terrain[0], late, 25), 1e-5);
  for (std::size_t i = 0; i < late.position.size(); ++i)
    EXPECT_LT(length(late.position[i] - early.position[i]), 1e-6);
}

// Cubes in grooves of several angles and in a corner of three planes: all come to rest, none below a surface.
TEST(ImplicitRest, CubesInGroovesAndInACorner) {
  for (const double slope : {0.4, 1.0, 2.5}) {
    ModelSettings settings = cube(5, {0.0, 2.0 + 2.9 * std::sqrt(1.0 + slope * slope), 0.0});
    settings.cubes[0].rotation = {{0.0, 0.0, 1.0}, 45.0};
    settings.contact.friction = 0.5;
    settings.terrain = {plane({}, {slope, 1, 0}), plane({}, {-slope, 1, 0})};
    const Model model = test::build(settings);
    const State end = advanced(*solver_for(model), 600);
    EXPECT_LT(fastest(end), 1e-6) << slope;
    for (const Terrain& side : model.terrain) EXPECT_LT(layer(side, end, 5), 1e-5) << slope;
  }
  ModelSettings settings = cube(5, {0.5, 3.0, 0.3});
  settings.cubes[0].velocity = {-6.0, 0.0, -4.0};
  settings.terrain = {plane({0, -1, 0}, {0, 1, 0}), plane({-3, 0, 0}, {1, 0, 0}),
                      plane({0, 0, -3}, {0, 0, 1})};
  const Model model = test::build(settings);
  const State end = advanced(*solver_for(model), 600);
  EXPECT_LT(fastest(end), 1e-6);
  EXPECT_LT(layer(model.terrain[0], end, 25), 1e-5);
  for (const Terrain& side : model.terrain) EXPECT_GE(signed_distance(side, end.position[0]), -1e-12);
}

// Without friction nothing but the second plane stops it.
TEST(ImplicitRest, AParticleInAGrooveWithoutFriction) {
  for (const double slope : {0.1, 1.0, 5.0}) {
    ContactSettings contact;
    contact.friction = 0.0;
    contact.restitution = 0.0;
    const Model model =
        loose({{0.1, 1.0, 0.0}}, {{}}, {plane({}, {slope, 1, 0}), plane({}, {-slope, 1, 0})}, contact);
    const State end = advanced(*solver_for(model), 600);
    EXPECT_LT(fastest(end), 1e-6) << slope;
    EXPECT_LT(std::hypot(end.position[0].x, end.position[0].y), 1e-6) << slope;
  }
}

TEST(ImplicitRest, SphereAndBowl) {
  TerrainSettings sphere, bowl;
  sphere.shape = TerrainShape::sphere;
  bowl.shape = TerrainShape::bowl;
  const Terrain round = make_terrain(sphere, ContactSettings{});
  const Vec3 top =
      round.geometry.vectors[0] + round.geometry.numbers[0] * Vec3{std::sin(0.1), std::cos(0.1), 0.0};
  const Model on_top = loose({top}, {{}}, {sphere});
  const State held = advanced(*solver_for(on_top), 600);
  EXPECT_LE(length(held.position[0] - top), 600 * 8 * eps * round.geometry.numbers[0]) << "μ = 0.3 > tan 0.1";
  const Terrain hollow = make_terrain(bowl, ContactSettings{});
  const Model model = loose({hollow.geometry.vectors[0] - Vec3{4.0, 3.0, 1.0}}, {{1, 0, 2}}, {bowl});
  const State end = advanced(*solver_for(model), 1200);
  EXPECT_LT(fastest(end), 1e-6);
  EXPECT_LT(std::abs(signed_distance(hollow, end.position[0])), 1e-9);
  const Vec3 out = end.position[0] - hollow.geometry.vectors[0];
  EXPECT_LE(std::hypot(out.x, out.z), 0.3 * -out.y * (1.0 + 1e-9)) << "within the cone";

  ModelSettings settings = cube(5, {3.0, 7.5, 0.5});
  settings.terrain = {bowl};
  const Model rocking = test::build(settings);
  EXPECT_LT(fastest(advanced(*solver_for(rocking), 900)), 1e-3);
}

TEST(ImplicitRest, PinnedParticlesTakeNoPart) {
  Model model = loose({{0, 0.005, 0}, {1, -0.5, 0}, {2, 0, 0}}, {{1, -2, 0}, {}, {}}, {plane({}, {0, 1, 0})});
  model.inverse_mass = {1.0, 0.0, 0.0};
  const State start = initial_state(model, Precision::double_), end = advanced(*solver_for(model), 30);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(end.position[i], start.position[i]);
    EXPECT_EQ(end.velocity[i], start.velocity[i]);
  }
  EXPECT_NE(end.position[0], start.position[0]);
}

// At rest on the ground the sum of the momenta that the ground gives is the weight's, step by step: the
// cube's momentum stays what it is, while in flight it is gravity's alone.
TEST(ImplicitRest, MomentumInFlightIsGravitysAlone) {
  const Model model = test::build(cube(5, {0.0, 9.0, 0.0}));
  const auto solver = solver_for(model);
  for (int n = 1; n <= 60; ++n) {
    const Vec3 momentum = measure(model, advanced(*solver, 1)).momentum;
    EXPECT_LE(length(momentum - Vec3{0, -125 * g * n * h, 0}), 125 * n * tolerance);
  }
}

}  // namespace
}  // namespace aspic
