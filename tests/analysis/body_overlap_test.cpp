#include "analysis/body_overlap.h"

#include <gtest/gtest.h>

#include "support/model_building.h"

namespace aspic {
namespace {

constexpr double s = 0.5;

CubeSettings cube_at(const Vec3& position, double edge = 2.0) {
  CubeSettings cube;
  cube.particles_per_edge = static_cast<int>(edge / s + 1.5);
  cube.edge_length = edge;
  cube.position = position;
  return cube;
}

std::vector<BodyOverlap> overlaps(std::vector<CubeSettings> cubes) {
  ModelSettings settings;
  settings.cubes = std::move(cubes);
  const Model model = test::build(settings);
  return overlaps_of(model, initial_state(model, Precision::double_));
}

std::vector<BodyOverlap> deep(const Model& model) {
  return DeepPoints(model).find(initial_state(model, Precision::double_),
                                [](std::uint32_t, std::uint32_t) { return false; });
}

TEST(BodyOverlap, HasDepthAndEnergyOfContact) {
  // A fifth of a spacing, over the whole face.
  const auto found = overlaps({cube_at({}), cube_at({0.0, 1.9, 0.0}), cube_at({10.0, 0.0, 0.0})});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].a, 0u);
  EXPECT_EQ(found[0].b, 1u);
  EXPECT_NEAR(found[0].deepest, 0.1, 1e-12);
  EXPECT_NEAR(found[0].most, s, 1e-12);
  EXPECT_FALSE(found[0].locked());
  // ½k(ρ − d)² of each point, of which both faces have 25 and 2 on each of 16 edges.
  const double near = 0.1 * s + 0.1;
  EXPECT_NEAR(found[0].energy, 2 * (25 + 32) * 0.5 * 7.3125 * 2000.0 * near * near, 1e-6);
}

TEST(BodyOverlap, ComparesFewOfACrowdWithEachOther) {
  std::vector<CubeSettings> crowd;
  for (int n = 0; n < 60; ++n) crowd.push_back(cube_at({0.01 * n, 0.0, 0.0}));
  crowd.push_back(cube_at({50.0, 0.0, 0.0}));
  crowd.push_back(cube_at({50.0, 1.9, 0.0}));
  const auto found = overlaps(crowd);
  EXPECT_EQ(found.size(), most_crowded * (most_crowded - 1) / 2 + 1);
  EXPECT_EQ(found.back().a, 60u);
  EXPECT_EQ(found.back().b, 61u);
}

TEST(BodyOverlap, IsNoneForBodiesInContactOrWithoutContact) {
  EXPECT_TRUE(overlaps({cube_at({}), cube_at({0.0, 2.0, 0.0})}).empty());
  EXPECT_TRUE(overlaps({cube_at({}), cube_at({0.0, 2.03, 0.0})}).empty());
  ModelSettings settings;
  settings.cubes = {cube_at({}), cube_at({0.0, 1.0, 0.0})};
  settings.contact.bodies = false;
  const Model model = test::build(settings);
  EXPECT_TRUE(overlaps_of(model, initial_state(model, Precision::double_)).empty());
  EXPECT_TRUE(deep(model).empty());
}

TEST(BodyOverlap, WhatIsDeeperThanASpacingIsLocked) {
  // A small cube in the middle of a large one, turned: its center is 2 m below the surface.
  CubeSettings small = cube_at({0.1, 0.05, 0.0}, 1.0);
  small.rotation = {{1.0, 2.0, 0.5}, 40.0};
  const auto found = overlaps({cube_at({}, 4.0), small});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].locked());
  EXPECT_GT(found[0].deepest, 1.3);
  EXPECT_LT(found[0].deepest, 2.0);
}

// All points of their surfaces are next to faces that turn the same way: the particles inside tell.
TEST(BodyOverlap, OfBodiesNearlyInOnePlaceIsTold) {
  for (const Vec3& at : {Vec3{}, Vec3{0.1, 0.0, 0.0}, Vec3{0.3, 0.3, 0.3}}) {
    const auto found = overlaps({cube_at({}, 4.0), cube_at(at, 4.0)});
    ASSERT_EQ(found.size(), 1u) << at.x;
    EXPECT_TRUE(found[0].locked()) << at.x;
    // Not every particle is looked at: one a spacing from the deepest is.
    EXPECT_GT(found[0].deepest, 2.0 - at.x - s - 1e-9) << at.x;
    EXPECT_LT(found[0].deepest, 2.0 + 1e-9) << at.x;
  }
  CubeSettings turned = cube_at({}, 4.0);
  turned.rotation = {{0.0, 1.0, 0.0}, 30.0};
  EXPECT_EQ(overlaps({cube_at({}, 4.0), turned}).size(), 1u);
  EXPECT_EQ(overlaps({cube_at({}, 4.0), cube_at({0.05, 0.0, 0.0}, 3.5)}).size(), 1u);
}

// Rays from the points of aligned bodies of one spacing run through corners and sides of triangles.
TEST(BodyOverlap, AlignedBodiesOfOneSpacingAreNoneTheLess) {
  const auto found =
      overlaps({cube_at({}, 4.0), cube_at({0.0, 0.5, 0.0}, 1.0), cube_at({0.5, 4.5, 0.0}, 1.0)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].b, 1u);
  EXPECT_TRUE(found[0].locked());
  EXPECT_NEAR(found[0].deepest, 2.0, 1e-12) << "the middle of its lower face";
}

// Points in the box of a body that is not there: above the lower cell of an L, and beside a turned cube.
TEST(BodyOverlap, KnowsInsideFromTheBoxAround) {
  ModelSettings settings;
  VoxelsSettings& corner = settings.voxels.emplace_back();
  corner.size = s;
  corner.position = {};
  corner.layers.assign(8, {"111.....", "111.....", "111.....", "111....."});
  for (std::size_t y = 0; y < 3; ++y) corner.layers[y].assign(4, "11111111");
  // The inner corner is 1.5 m, three cells, wide.
  settings.cubes = {cube_at({1.0, 1.0, 0.0}, 1.0)};
  const Model model = test::build(settings);
  EXPECT_TRUE(deep(model).empty());
  settings.cubes[0].position = {-1.3, 0.0, 0.0};
  const auto found = deep(test::build(settings));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_GT(found[0].deepest, s);
  CubeSettings turned = cube_at({}, 4.0);
  turned.rotation = {{0.0, 1.0, 0.0}, 45.0};
  settings.voxels.clear();
  settings.cubes = {turned, cube_at({2.2, 0.0, 2.2}, 1.0)};
  EXPECT_TRUE(deep(test::build(settings)).empty());
}

}  // namespace
}  // namespace aspic
