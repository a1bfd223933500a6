// The cloth: topology, rest lengths, geometry and pins against a second statement of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "model/counts.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

Model model_of(const ClothSettings& cloth) {
  return test::build_alone<&ModelSettings::cloths>(cloth);
}

std::vector<std::uint32_t> pinned_in(const Model& model) {
  std::vector<std::uint32_t> held;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i)
    if (model.inverse_mass[i] == 0.0) held.push_back(i);
  return held;
}

class ClothLattice : public testing::TestWithParam<std::array<int, 2>> {};

// Every pair of lattice points is looked at: the differences say which spring joins them, if any.
TEST_P(ClothLattice, JoinsNeighborsDiagonalsAndSecondNeighbors) {
  ClothSettings cloth;
  cloth.particles = GetParam();
  cloth.size = {1.5, 0.7};
  const auto [w, h] = cloth.particles;
  const Model model = model_of(cloth);
  std::map<std::array<std::uint32_t, 2>, SpringClass> expected;
  const double sx = 1.5 / (w - 1), sy = 0.7 / (h - 1);
  for (int p = 0; p < w * h; ++p) {
    for (int q = p + 1; q < w * h; ++q) {
      const int di = q / h - p / h, dj = std::abs(q % h - p % h);
      const bool next = di + dj == 1, across = di == 1 && dj == 1, second = di + dj == 2 && di * dj == 0;
      if (!next && !across && !second) continue;
      const SpringType type = next     ? SpringType::structural
                              : across ? SpringType::shear
                                       : SpringType::bending;
      const SpringSettings& of = next ? cloth.structural : across ? cloth.shear : cloth.bending;
      expected[{static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(q)}] = {
          type, of.stiffness, of.damping, std::hypot(di * sx, dj * sy), false};
    }
  }
  ASSERT_EQ(spring_count(model), expected.size());
  for (const Spring& s : springs_of(model)) {
    const auto found = expected.find({s.a, s.b});
    ASSERT_NE(found, expected.end()) << s.a << " " << s.b;
    const SpringClass& c = model.spring_classes[s.spring_class];
    EXPECT_EQ(c.type, found->second.type);
    EXPECT_EQ(c.stiffness, found->second.stiffness);
    EXPECT_EQ(c.damping, found->second.damping);
    EXPECT_FALSE(c.cord);
    EXPECT_NEAR(c.rest_length, found->second.rest_length, 4 * 2.3e-16 * 1.5);
    // Positions of up to 4 m are rounded once each.
    const double now = length(model.initial_position[s.a] - model.initial_position[s.b]);
    EXPECT_NEAR(now, c.rest_length, 8 * 2.3e-16 * 4.0);
  }
  const std::vector<Spring> springs = all_springs(model);
  EXPECT_TRUE(std::is_sorted(springs.begin(), springs.end(), [](const Spring& a, const Spring& b) {
    return std::tie(a.a, a.b) < std::tie(b.a, b.b);
  }));
  const ModelCounts counts = count(model);
  EXPECT_EQ(counts.particles, static_cast<std::uint64_t>(w * h));
  EXPECT_EQ(counts.structural, static_cast<std::uint64_t>((w - 1) * h + w * (h - 1)));
  EXPECT_EQ(counts.shear, static_cast<std::uint64_t>(2 * (w - 1) * (h - 1)));
  EXPECT_EQ(counts.bending, static_cast<std::uint64_t>((w - 2) * h + w * (h - 2)));
  ModelSettings settings;
  settings.cloths.push_back(cloth);
  EXPECT_EQ(predict_counts(settings).springs(), counts.springs());
}

INSTANTIATE_TEST_SUITE_P(Sizes, ClothLattice,
                         testing::Values(std::array{2, 2}, std::array{2, 3}, std::array{3, 2},
                                         std::array{3, 3}, std::array{2, 7}, std::array{7, 2},
                                         std::array{5, 8}, std::array{9, 4}),
                         [](const auto& size) {
                           return std::to_string(size.param[0]) + "x" + std::to_string(size.param[1]);
                         });

TEST(Cloth, LiesInItsPlaneAroundItsCenterAndTurnsWithIt) {
  ClothSettings cloth;
  cloth.particles = {3, 5};
  cloth.size = {2.0, 4.0};
  cloth.position = {1.0, 2.0, 3.0};
  const Model flat = model_of(cloth);
  EXPECT_EQ(flat.initial_position[0], (Vec3{0.0, 0.0, 3.0})) << "lower left";
  EXPECT_EQ(flat.initial_position[4], (Vec3{0.0, 4.0, 3.0})) << "upper left: j counts along the height";
  EXPECT_EQ(flat.initial_position[5], (Vec3{1.0, 0.0, 3.0}));
  EXPECT_EQ(flat.initial_position[14], (Vec3{2.0, 4.0, 3.0}));
  cloth.rotation = {{1.0, 0.0, 0.0}, 90.0};
  const Model lying = model_of(cloth);
  for (const Vec3& x : lying.initial_position) EXPECT_NEAR(x.y, 2.0, 1e-15 * 4.0);
  EXPECT_NEAR(lying.initial_position[4].z, 5.0, 1e-15 * 8.0) << "y turns to z";
}

TEST(Cloth, IsPinnedByEdgesCornersAndIndices) {
  ClothSettings cloth;
  cloth.particles = {4, 3};  // local index 3·i + j
  cloth.velocity = {0.0, 0.0, 2.0};
  const auto held_by = [&](PinnedSettings pinned) {
    cloth.pinned = std::move(pinned);
    return pinned_in(model_of(cloth));
  };
  using Indices = std::vector<std::uint32_t>;
  EXPECT_EQ(held_by({}), Indices{});
  EXPECT_EQ(held_by({{"left"}, {}}), (Indices{0, 1, 2}));
  EXPECT_EQ(held_by({{"right"}, {}}), (Indices{9, 10, 11}));
  EXPECT_EQ(held_by({{"bottom"}, {}}), (Indices{0, 3, 6, 9}));
  EXPECT_EQ(held_by({{"top"}, {}}), (Indices{2, 5, 8, 11}));
  EXPECT_EQ(held_by({{"top-left"}, {}}), (Indices{2}));
  EXPECT_EQ(held_by({{"left-top", "bottom-right"}, {4}}), (Indices{2, 4, 9}));
  const Model model = model_of(cloth);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    EXPECT_EQ(model.initial_velocity[i].z, model.inverse_mass[i] == 0.0 ? 0.0 : 2.0);
    EXPECT_EQ(model.mass[i], cloth.particle_mass);
  }
}

TEST(Cloth, RefusesPinsThatItDoesNotHave) {
  const std::pair<PinnedSettings, const char*> cases[] = {
      {{{"front"}, {}},
       "cloth[0].pinned: \"front\" is neither an edge (top, bottom, left, right) nor a corner"},
      {{{"top-bottom"}, {}}, "neither an edge"},
      {{{"top-left-left"}, {}}, "neither an edge"},
      {{{}, {12}}, "cloth[0].pinned: index 12 is not in the cloth; allowed: 0 … 11"}};
  for (const auto& [pinned, message] : cases) {
    ModelSettings settings;
    settings.cloths.resize(1);
    settings.cloths[0].particles = {4, 3};
    settings.cloths[0].pinned = pinned;
    const auto model = build_model(settings);
    ASSERT_FALSE(model.ok());
    EXPECT_EQ(model.error().code, ErrorCode::scene_rejected);
    EXPECT_NE(model.error().message().find(message), std::string::npos) << model.error().message();
  }
}

TEST(Cloth, HasOneOpenSurfaceAndARodWhereAnEdgeIsPinned) {
  ClothSettings cloth;
  cloth.particles = {4, 3};
  const Model loose = model_of(cloth);
  ASSERT_EQ(loose.bodies.size(), 1u);
  EXPECT_EQ(loose.bodies[0].style, SurfaceStyle::sheet);
  EXPECT_TRUE(loose.bodies[0].rods.empty());
  const QuadMesh surface = surface_of(loose.bodies[0]);
  ASSERT_EQ(surface.groups.size(), 1u);
  ASSERT_EQ(surface.quads.size(), 3u * 2);
  std::set<std::uint32_t> covered;
  for (const Quad& quad : surface.quads) covered.insert(quad.begin(), quad.end());
  EXPECT_EQ(covered.size(), 12u) << "every particle is on it";
  EXPECT_EQ(*covered.rbegin(), 11u);
  cloth.pinned.names = {"top", "left-bottom"};
  const std::vector<Rod> rods = model_of(cloth).bodies[0].rods;
  ASSERT_EQ(rods.size(), 1u) << "a corner does not make an edge";
  EXPECT_EQ(rods[0].from, (Vec3{-1.5, 4.0, 0.0}));
  EXPECT_EQ(rods[0].to, (Vec3{1.5, 4.0, 0.0}));
  cloth.pinned.names = {"left", "right", "bottom", "top"};
  EXPECT_EQ(model_of(cloth).bodies[0].rods.size(), 4u);
}

}  // namespace
}  // namespace aspic
