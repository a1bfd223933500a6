#include "model/cube.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "model/springs.h"

namespace aspic {
namespace {

Model cube_of(int n, double edge = 4.0) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = n;
  cube.edge_length = edge;
  settings.cubes.push_back(cube);
  auto model = build_model(settings);
  EXPECT_TRUE(model.ok());
  return std::move(model).value();
}

TEST(Cube, TenPerEdgeHasThePublishedCounts) {
  const ModelCounts counts = count(cube_of(10));
  EXPECT_EQ(counts.particles, 1000u);
  EXPECT_EQ(counts.structural, 2700u);
  EXPECT_EQ(counts.shear, 7776u);
  EXPECT_EQ(counts.bending, 2400u);
  EXPECT_EQ(counts.springs(), 12876u);
}

class CubeLattice : public testing::TestWithParam<int> {};

// The set of springs is derived here from distances alone, by comparing all pairs of particles: an
// independent statement of "axis neighbors, face and body diagonals, two steps along an axis".
TEST_P(CubeLattice, SpringsAreThosePairsAtTheirDistances) {
  const int n = GetParam();
  const double edge = 3.0, s = edge / (n - 1);
  const Model model = cube_of(n, edge);
  std::set<std::pair<std::uint32_t, std::uint32_t>> expected[3];
  for (std::uint32_t a = 0; a < model.particle_count(); ++a) {
    for (std::uint32_t b = a + 1; b < model.particle_count(); ++b) {
      const Vec3 d = model.initial_position[b] - model.initial_position[a];
      const double squared = dot(d, d) / (s * s);
      const auto steps = std::lround(squared);
      if (std::abs(squared - static_cast<double>(steps)) > 1e-6) continue;
      const bool along_axis = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) / s > 1.5;
      if (steps == 1) expected[0].insert({a, b});
      if (steps == 2 || steps == 3) expected[1].insert({a, b});
      if (steps == 4 && along_axis) expected[2].insert({a, b});
    }
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> actual[3];
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    EXPECT_TRUE(actual[static_cast<int>(c.type)].insert({spring.a, spring.b}).second) << "duplicate spring";
    const Vec3 d = model.initial_position[spring.b] - model.initial_position[spring.a];
    // Positions carry a rounding of a few ulp of the coordinates (up to 11 m), lengths inherit it.
    EXPECT_NEAR(c.rest_length, length(d), 64 * 2.3e-16 * 11.0);
  }
  for (int type = 0; type < 3; ++type) EXPECT_EQ(actual[type], expected[type]);

  const ModelCounts counted = count(model), closed_form = box_counts({n, n, n});
  EXPECT_EQ(counted.particles, closed_form.particles);
  EXPECT_EQ(counted.structural, closed_form.structural);
  EXPECT_EQ(counted.shear, closed_form.shear);
  EXPECT_EQ(counted.bending, closed_form.bending);
}

TEST_P(CubeLattice, SpringsAreSortedByTheirEnds) {
  const Model model = cube_of(GetParam());
  const std::vector<Spring> springs = all_springs(model);
  ASSERT_EQ(springs.size(), spring_count(model));
  for (std::size_t s = 1; s < springs.size(); ++s) {
    const Spring &p = springs[s - 1], &q = springs[s];
    EXPECT_LT(std::tie(p.a, p.b), std::tie(q.a, q.b));
    EXPECT_LT(q.a, q.b);
  }
}

INSTANTIATE_TEST_SUITE_P(TwoToTwelve, CubeLattice, testing::Range(2, 13));

TEST(Cube, LocalIndexRunsZFastest) {
  const Model model = cube_of(3, 2.0);
  EXPECT_EQ(model.initial_position[0], (Vec3{-1.0, 8.0, -1.0}));
  EXPECT_EQ(model.initial_position[1], (Vec3{-1.0, 8.0, 0.0}));
  EXPECT_EQ(model.initial_position[3], (Vec3{-1.0, 9.0, -1.0}));
  EXPECT_EQ(model.initial_position[9], (Vec3{0.0, 8.0, -1.0}));
}

TEST(Cube, RotationKeepsCenterAndLengths) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = 4;
  cube.rotation = {{1.0, 2.0, -0.5}, 37.0};
  settings.cubes.push_back(cube);
  const auto model = build_model(settings);
  ASSERT_TRUE(model.ok());
  Vec3 sum;
  for (const Vec3& x : model->initial_position) sum = sum + x;
  const Vec3 center = sum / 64.0;
  EXPECT_NEAR(length(center - cube.position), 0.0, 1e-13);
  for (const Spring& spring : springs_of(*model)) {
    const Vec3 d = model->initial_position[spring.b] - model->initial_position[spring.a];
    EXPECT_NEAR(length(d), model->spring_classes[spring.spring_class].rest_length, 1e-13);
  }
}

TEST(Cube, QuarterTurnAboutZTakesXToY) {
  const Vec3 turned = rotated({1.0, 0.0, 0.0}, {0.0, 0.0, 5.0}, 90.0);
  EXPECT_NEAR(turned.x, 0.0, 1e-15);
  EXPECT_NEAR(turned.y, 1.0, 1e-15);
}

TEST(Cube, MaterialMeansTheSameJellyAtEveryResolution) {
  CubeSettings cube;
  cube.material.emplace();
  for (const int n : {4, 8, 16, 64}) {
    cube.particles_per_edge = n;
    const double mass = material_particle_mass(cube);
    EXPECT_NEAR(mass * n * n * n, 16.0 * 64.0, 1e-9);
    const SpringSettings springs = material_springs(cube);
    const double s = 4.0 / (n - 1);
    EXPECT_NEAR(7.3125 * springs.stiffness / s, 33000.0, 1e-8);
    EXPECT_NEAR(springs.damping / (2.0 * std::sqrt(springs.stiffness * mass / 2.0)), 0.95, 1e-14);
  }
}

Result<Model> pinned_cube(PinnedSettings pinned) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = 5;
  cube.velocity = {1.0, 2.0, 3.0};
  cube.pinned = std::move(pinned);
  settings.cubes.push_back(cube);
  return build_model(settings);
}

TEST(CubePinned, FacesCornersAndIndices) {
  auto face = pinned_cube({{"top"}, {}});
  ASSERT_TRUE(face.ok());
  EXPECT_EQ(count(*face).pinned, 25u);
  for (std::uint32_t p = 0; p < face->particle_count(); ++p) {
    const bool top = face->initial_position[p].y == 11.0;
    EXPECT_EQ(face->inverse_mass[p] == 0.0, top);
    EXPECT_EQ(face->mass[p], 1.0);
    EXPECT_EQ(face->initial_velocity[p], top ? Vec3{} : (Vec3{1.0, 2.0, 3.0}));
  }
  auto corner = pinned_cube({{"right-top-front"}, {}});
  ASSERT_TRUE(corner.ok());
  EXPECT_EQ(corner->inverse_mass[124], 0.0);
  EXPECT_EQ(count(*corner).pinned, 1u);
  auto several = pinned_cube({{"left", "bottom"}, {124, 124}});
  ASSERT_TRUE(several.ok());
  EXPECT_EQ(count(*several).pinned, 25u + 25u - 5u + 1u);
}

TEST(CubePinned, RefusesUnknownNamesAndIndices) {
  for (const char* name : {"upper", "", "left-right-top", "left-top", "left-left-left", "left--top"}) {
    const auto model = pinned_cube({{name}, {}});
    ASSERT_FALSE(model.ok()) << name;
    EXPECT_EQ(model.error().code, ErrorCode::scene_rejected);
    EXPECT_NE(model.error().message().find("cube[0].pinned"), std::string::npos);
  }
  EXPECT_TRUE(pinned_cube({{}, {124}}).ok());
  EXPECT_FALSE(pinned_cube({{}, {125}}).ok());
}

TEST(Model, TooManyParticlesAreRefusedBeforeAllocation) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = 1291;  // 1290³ is the last below 2³¹
  settings.cubes.push_back(cube);
  const auto model = build_model(settings);
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.error().code, ErrorCode::scene_rejected);
}

TEST(Model, NegativeZeroIsReadAsZero) {
  ModelSettings settings;
  CubeSettings cube;
  cube.velocity = {-0.0, -1e-60, 1.0};
  settings.cubes.push_back(cube);
  settings.simulation.gravity = {-0.0, -9.8, 0.0};
  const auto model = build_model(settings);
  ASSERT_TRUE(model.ok());
  EXPECT_FALSE(std::signbit(model->simulation.gravity.x));
  const State state = initial_state(*model, Precision::single);
  EXPECT_FALSE(std::signbit(state.velocity[0].x));
  EXPECT_FALSE(std::signbit(state.velocity[0].y));
  EXPECT_EQ(initial_state(*model, Precision::double_).velocity[0].y, -1e-60);
}

// Every number of particles: compilers treat those that are left over from vectors apart.
TEST(InitialState, IsRoundedToItsPrecision) {
  for (std::size_t n = 1; n <= 40; ++n) {
    Model model;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = static_cast<double>(i);
      model.initial_position.push_back({0.1 + x, 0.2 + x, 0.3 + x});
      model.initial_velocity.push_back({0.6 - x, 0.7 - x, 0.9 - x});
    }
    const State exact = initial_state(model, Precision::double_);
    EXPECT_EQ(exact.position, model.initial_position.list(0, n));
    const State state = initial_state(model, Precision::single);
    for (std::size_t i = 0; i < n; ++i) {
      for (const auto& [rounded, given] : {std::pair{state.position[i], exact.position[i]},
                                           std::pair{state.velocity[i], exact.velocity[i]}}) {
        const volatile float x = static_cast<float>(given.x), y = static_cast<float>(given.y),
                             z = static_cast<float>(given.z);
        EXPECT_EQ(rounded, (Vec3{x, y, z})) << "particle " << i << " of " << n;
      }
    }
  }
}

TEST(StateHash, SeesEveryBitAndThePrecision) {
  const Model model = cube_of(3);
  State state = initial_state(model, Precision::single);
  const std::uint64_t first = state_hash(state);
  state.velocity[26].z = std::nextafter(0.0f, 1.0f);
  EXPECT_NE(state_hash(state), first);
  EXPECT_NE(state_hash(initial_state(model, Precision::double_)), first);
}

}  // namespace
}  // namespace aspic
