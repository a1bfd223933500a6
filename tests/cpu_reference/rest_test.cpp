// Bodies in Coulomb contact come to rest, under every explicit method: cubes, slopes, several terrains at
// once, pinned particles. Closed forms are rows of aspic verify (Battery.ContactWithTerrain...).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aspic/analysis.h"
#include "model/terrain.h"
#include "support/epsilon.h"
#include "support/integrator_names.h"
#include "support/model_building.h"
#include "support/reference_runs.h"

namespace aspic {
namespace {

using test::advanced;
using test::after;
using test::fastest;
using test::layer;
using test::solver_for;

using test::eps;
constexpr double h = 0.001, g = 9.8;

Terrain plane(const Vec3& point, const Vec3& normal, double e, double mu) {
  TerrainSettings settings;
  settings.geometry["point"] = point;
  settings.geometry["normal"] = normal;
  settings.restitution = e;
  settings.friction = mu;
  return make_terrain(settings, ContactSettings{});
}

class Rest : public testing::TestWithParam<Integrator> {
 protected:
  static Model loose(std::vector<Vec3> positions, const std::vector<Vec3>& velocities,
                     std::vector<Terrain> terrain) {
    Model model = test::particles(std::move(positions), velocities);
    model.simulation.integrator = GetParam();
    model.terrain = std::move(terrain);
    return model;
  }
  static ModelSettings cube(const Vec3& position) {
    ModelSettings settings = test::cube_on_plane(5);
    settings.simulation.integrator = GetParam();
    settings.cubes[0].position = position;
    return settings;
  }
};
INSTANTIATE_TEST_SUITE_P(Explicit, Rest, testing::ValuesIn(explicit_integrators), test::by_integrator);

// The cone holds it: μ = 0.5 > tan 15° = 0.268.
TEST_P(Rest, ACubeOnASlopeItSticksTo) {
  const double angle = 15.0 * std::numbers::pi / 180.0;
  const Vec3 n = {std::sin(angle), std::cos(angle), 0.0};
  ModelSettings settings = cube(2.5 * n);
  settings.cubes[0].rotation = {{0.0, 0.0, 1.0}, -15.0};
  settings.terrain[0].geometry["point"] = Vec3{};
  settings.terrain[0].geometry["normal"] = n;
  settings.terrain[0].friction = 0.5;
  const Model model = test::build(settings);
  const auto solver = solver_for(model);
  const State early = advanced(*solver, 4200), late = advanced(*solver, 800);
  EXPECT_LT(fastest(late), 1e-6);
  EXPECT_LT(layer(model.terrain[0], late, 25), 1e-5);
  double drift = 0.0;
  for (std::size_t i = 0; i < late.position.size(); ++i)
    drift = std::max(drift, length(late.position[i] - early.position[i]));
  EXPECT_LT(drift, 1e-6);
}

// Cubes whose faces lie on both sides of a groove, and on the three sides of a corner.
TEST_P(Rest, ACubeInAGrooveAndInACorner) {
  for (const bool corner : {false, true}) {
    ModelSettings settings = cube({2.3, 2.3, corner ? 2.3 : 0.0});
    const double along = g / std::sqrt(corner ? 3.0 : 2.0);
    settings.simulation.gravity = {-along, -along, corner ? -along : 0.0};
    settings.terrain.clear();
    for (int side = 0; side < (corner ? 3 : 2); ++side) {
      TerrainSettings wall;
      wall.geometry["point"] = Vec3{};
      wall.geometry["normal"] = Vec3{side == 0 ? 1.0 : 0.0, side == 1 ? 1.0 : 0.0, side == 2 ? 1.0 : 0.0};
      settings.terrain.push_back(wall);
    }
    const Model model = test::build(settings);
    const State end = after(model, 4000);
    EXPECT_LT(fastest(end), 1e-6) << (corner ? "corner" : "groove");
    for (const Terrain& wall : model.terrain) EXPECT_LT(layer(wall, end, 25), 1e-5);
  }
}

// Slopes that are not at right angles: each acts on what the one before left, so that a step's two passes
// over both leave at most |n₁·n₂|³ of what gravity adds in a step, which the next step takes away again.
TEST_P(Rest, ParticlesInANarrowGroove) {
  const Vec3 left = {0.8, 0.6, 0.0}, right = {-0.8, 0.6, 0.0};
  const Model model = loose({{0.1, 1.0, 0.0}, {-0.4, 0.7, 1.0}}, {{0, 0, 0}, {0.3, 0, 0.1}},
                            {plane({}, left, 0.3, 0.2), plane({}, right, 0.3, 0.2)});
  const auto solver = solver_for(model);
  const State early = advanced(*solver, 5000), late = advanced(*solver, 1000);
  const double remainder = std::pow(std::abs(dot(left, right)), 3) * g * h;
  EXPECT_LT(fastest(late), remainder);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::hypot(late.position[i].x, late.position[i].y), h * remainder);
    EXPECT_LE(length(late.position[i] - early.position[i]), 1000 * 4 * eps);
  }
}

TEST_P(Rest, ACubeOnItsCornersInABowl) {
  ModelSettings settings = cube({2.0, 3.0, 1.0});
  settings.terrain[0].shape = TerrainShape::bowl;
  const Model model = test::build(settings);
  const State end = after(model, 6500);
  EXPECT_LT(fastest(end), 1e-6);
  EXPECT_LT(layer(model.terrain[0], end, 4), 1e-5);
}

// Particles slide back and forth until friction holds them: no steeper than tan θ = μ, at a distance and with
// a speed towards the surface that rounding leaves.
TEST_P(Rest, ParticlesInABowl) {
  TerrainSettings settings;
  settings.shape = TerrainShape::bowl;
  const Terrain bowl = make_terrain(settings, ContactSettings{});
  std::vector<Vec3> positions;
  for (int i = 0; i < 8; ++i) positions.push_back(bowl.geometry.vectors[0] + Vec3{0.7 * i, -3.0, 0.3 * i});
  const Model model = loose(positions, std::vector<Vec3>(8), {bowl});
  const State end = after(model, 20000);
  EXPECT_LT(fastest(end), 16 * eps * bowl.geometry.numbers[0] / h);
  EXPECT_LT(layer(bowl, end, 8), 8 * eps * bowl.geometry.numbers[0]);
  for (const Vec3& x : end.position) {
    const Vec3 e = x - bowl.geometry.vectors[0];
    EXPECT_LT(std::hypot(e.x, e.z) / -e.y, bowl.friction * (1.0 + 1e-6));
  }
}

// On a sphere's top a particle stays, if friction holds it; without friction it slides off and leaves the
// surface where cos θ = 2/3·cos θ₀, a textbook result.
TEST_P(Rest, OnASphereAndOffIt) {
  TerrainSettings settings;
  settings.shape = TerrainShape::sphere;
  settings.friction = 0.3;
  const Terrain rough = make_terrain(settings, ContactSettings{});
  const double R = rough.geometry.numbers[0], tilt = 0.1;
  const Vec3 start = rough.geometry.vectors[0] + R * Vec3{std::sin(tilt), std::cos(tilt), 0.0};
  const Model on_it = loose({start}, {{}}, {rough});
  const State held = after(on_it, 1000);
  EXPECT_LE(length(held.position[0] - start), 1000 * 8 * eps * R);

  settings.friction = 0.0;
  const Terrain smooth = make_terrain(settings, ContactSettings{});
  const Model off_it = loose({start}, {{}}, {smooth});
  const auto solver = solver_for(off_it);
  double left_at = 0.0;
  for (int n = 0; n < 3000 && left_at == 0.0; ++n) {
    const State now = advanced(*solver, 1);
    // The gap grows as 1/6·3g·sin θ·v/R·t³: 1e-5 m, above what a step along the surface rises, at t = 0.012
    // s.
    if (signed_distance(smooth, now.position[0]) > 1e-5)
      left_at = (now.position[0].y - smooth.geometry.vectors[0].y) /
                length(now.position[0] - smooth.geometry.vectors[0]);
  }
  EXPECT_NEAR(left_at, 2.0 / 3.0 * std::cos(tilt), 0.012 * std::sqrt(2.0 / 3.0 * g / R) + 4 * h);
}

TEST_P(Rest, PinnedParticlesTakeNoPart) {
  Model model = loose({{0, 0.005, 0}, {1, -0.5, 0}, {2, 0, 0}}, {{1, -2, 0}, {0, 0, 0}, {0, 0, 0}},
                      {plane({}, {0, 1, 0}, 0.8, 0.3)});
  model.inverse_mass = {1.0, 0.0, 0.0};
  const State start = initial_state(model, Precision::double_), end = after(model, 100);
  for (const std::size_t i : {1u, 2u}) {
    EXPECT_EQ(end.position[i], start.position[i]);
    EXPECT_EQ(end.velocity[i], start.velocity[i]);
  }
  EXPECT_NE(end.position[0], start.position[0]);
}

// Contact takes energy and never makes any: methods of higher order make none in flight either.
TEST(RestEnergy, NeverRises) {
  for (const Integrator integrator : {Integrator::midpoint, Integrator::runge_kutta_4}) {
    ModelSettings settings = test::cube_on_plane(5, 4.0);
    settings.simulation.integrator = integrator;
    settings.cubes[0].rotation = {{1.0, 0.0, 1.0}, 30.0};
    const Model model = test::build(settings);
    const auto solver = solver_for(model);
    const double start = measure(model, *solver->state()).total();
    for (int n = 0; n < 300; ++n)
      EXPECT_LE(measure(model, advanced(*solver, 20)).total(), start * (1.0 + 1e-9)) << name_of(integrator);
  }
}

}  // namespace
}  // namespace aspic
