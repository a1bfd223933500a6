// Pairs of bodies, turned at random, that meet at 0.9 of the speed up to which nothing passes
// (contact_facts()).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "analysis/body_overlap.h"
#include "analysis/contact_facts.h"
#include "aspic/analysis.h"
#include "base/split_mix.h"
#include "cpu_parallel/cpu_solver.h"
#include "support/model_building.h"

namespace aspic {
namespace {

constexpr double s = 0.45;  // spacing of the cubes [m]

struct ImpactKind {
  std::string name;
  std::array<int, 3> first;   // particles
  std::array<int, 3> second;  // of one layer: a sheet of 3 m across the way
  double ratio = 1.0;         // of the second's mass, stiffness and damping to the first's
  bool pinned = false;        // the sheet's edges are
  bool slips = false;         // may come past the other, turned by it: long or flat
};

const ImpactKind impact_kinds[] = {
    {"2^3", {2, 2, 2}, {2, 2, 2}},
    {"2^3, ten times", {2, 2, 2}, {2, 2, 2}, 10.0},
    {"3^3", {3, 3, 3}, {3, 3, 3}},
    {"3^3, ten times", {3, 3, 3}, {3, 3, 3}, 10.0},
    {"4^3", {4, 4, 4}, {4, 4, 4}},
    {"rods", {2, 2, 5}, {2, 2, 5}, 1.0, false, true},
    {"slab and cube", {5, 2, 5}, {3, 3, 3}, 1.0, false, true},
    {"slabs", {5, 2, 5}, {5, 2, 5}, 1.0, false, true},
    {"2^3, rigid sheet", {2, 2, 2}, {2, 2, 1}, 1.0, true},
    {"3^3, pinned cloth", {3, 3, 3}, {7, 7, 1}, 1.0, true},
    {"3^3, free cloth", {3, 3, 3}, {7, 7, 1}},
    {"2^3, free cloth", {2, 2, 2}, {4, 4, 1}},
};

RotationSettings random_rotation(SplitMix64& random) {
  const auto number = [&] { return 2.0 * random.share() - 1.0; };
  const Vec3 axis = {number(), number(), number()};
  return {axis, 180.0 * number()};
}

CubeSettings box_at_random(std::array<int, 3> particles, double scale, SplitMix64& random) {
  CubeSettings box;
  box.particles = particles;
  box.edge_length = (std::ranges::max(particles) - 1) * s;
  box.position = {};
  box.rotation = random_rotation(random);
  box.particle_mass = scale;
  box.structural = box.shear = box.bending = {2000.0 * scale, 60.08328 * scale};
  return box;
}

ClothSettings sheet_across(std::array<int, 3> particles, bool pinned) {
  ClothSettings cloth;
  cloth.particles = {particles[0], particles[1]};
  cloth.size = {3.0, 3.0};
  cloth.position = {};
  cloth.rotation = {{0.0, 1.0, 0.0}, 90.0};
  cloth.particle_mass = 0.1;
  cloth.structural = {400.0, 8.0};
  cloth.shear = {200.0, 4.0};
  cloth.bending = {20.0, 0.4};
  if (pinned) cloth.pinned.names = {"top", "bottom", "left", "right"};
  return cloth;
}

double radius_of(const CubeSettings& box) {
  double square = 0.0;
  for (const int n : box.lattice()) square += 0.25 * (n - 1) * (n - 1);
  return std::sqrt(square) * s;
}

double mean_x(const State& state, const Body& body) {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < body.particle_count; ++i) sum += state.position[body.first_particle + i].x;
  return sum / body.particle_count;
}

struct Impact {
  double rise = 0.0;  // the largest total energy, in that of the start
  bool inside = false, passed = false;
};

/// The first body comes along x; the other stands, or comes along -x where it is free and closed.
Impact impact(const ImpactKind& kind, double share, std::uint64_t seed) {
  SplitMix64 random(seed);
  ModelSettings settings;
  settings.simulation = {Integrator::symplectic_euler, 0.00025, 4.0, {}, 8, {}};
  settings.cubes = {box_at_random(kind.first, 1.0, random)};
  const bool sheet = kind.second[2] == 1;
  double way = radius_of(settings.cubes[0]) + 0.15;
  double other_mass = kind.ratio * kind.second[0] * kind.second[1] * kind.second[2];
  if (sheet) {
    settings.cloths = {sheet_across(kind.second, kind.pinned)};
  } else {
    settings.cubes.push_back(box_at_random(kind.second, kind.ratio, random));
    way += radius_of(settings.cubes[1]);
  }
  settings.cubes[0].position = {-way, 0.1 * random.share() - 0.05, 0.1 * random.share() - 0.05};
  double speed = 0.0;
  for (const ContactFacts facts = contact_facts(test::build(settings));
       const ContactPairing& pairing : facts.pairings)
    if (facts.kinds.size() == 1 || pairing.a != pairing.b) speed = share * pairing.speed();
  const double mass = kind.first[0] * kind.first[1] * kind.first[2];
  const double back = sheet ? 0.0 : mass / (mass + other_mass);  // share of the speed that the other has
  settings.cubes[0].velocity = {(1.0 - back) * speed, 0.0, 0.0};
  if (!sheet) settings.cubes[1].velocity = {-back * speed, 0.0, 0.0};

  const Model model = test::build(settings);
  const auto solver = std::move(*make_cpu_solver(model, {1}));
  State state = *solver->state();
  const double start = measure(model, state).total();
  Impact result;
  const auto end = static_cast<std::uint64_t>((2.5 * way / speed + 0.4) / settings.simulation.timestep);
  for (std::uint64_t step = 0; step < end; step += 20) {
    EXPECT_FALSE((*solver->advance(20)).divergence.has_value());
    state = *solver->state();
    result.rise = std::max(result.rise, measure(model, state).total() / start);
  }
  for (const BodyOverlap& overlap : overlaps_of(model, state))
    result.inside = result.inside || overlap.deepest > 0.25 * s;
  result.passed = mean_x(state, model.bodies[0]) > mean_x(state, model.bodies[1]);
  return result;
}

/// So many pairs of each kind. A point that comes in at an edge may be found up to D deep at once, by which
/// energy rises.
void expect_that_nothing_passes(std::uint64_t pairs) {
  for (const ImpactKind& kind : impact_kinds) {
    int inside = 0, passed = 0;
    double rise = 0.0;
    for (std::uint64_t n = 0; n < pairs; ++n) {
      const Impact found = impact(kind, 0.9, 1000 + n);
      inside += found.inside ? 1 : 0;
      passed += found.passed && !kind.slips ? 1 : 0;
      rise = std::max(rise, found.rise);
    }
    EXPECT_EQ(inside, 0) << kind.name;
    EXPECT_EQ(passed, 0) << kind.name;
    EXPECT_LT(rise, 1.25) << kind.name;
  }
}

TEST(Impacts, TurnBackAtNineTenthsOfTheSpeedThatIsPrinted) {
  expect_that_nothing_passes(3);
}

// Some minutes.
TEST(ManyImpacts, TurnBackAtNineTenthsOfTheSpeedThatIsPrinted) {
  expect_that_nothing_passes(100);
}

}  // namespace
}  // namespace aspic
