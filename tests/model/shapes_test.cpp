// What is particular to single terrain shapes: places where a formula has no direction of its own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/terrain.h"

namespace aspic {
namespace {

// The nearest point of the ring, sought among many, gives the distance: the formula knows it without a
// search.
TEST(Torus, DistanceIsThatToTheNearestPointOfTheRing) {
  const TerrainSettings settings = {
      .shape = TerrainShape::torus,
      .geometry = {
          {"center", Vec3{1, 2, 3}}, {"axis", Vec3{1, 2, -2}}, {"major-radius", 2.0}, {"minor-radius", 0.5}}};
  const Terrain torus = make_terrain(settings, {});
  const Vec3 axis = Vec3{1, 2, -2} / 3.0;
  const auto [first, second] = shapes::directions_across(axis);
  for (const Vec3& x : {Vec3{4, 2, 3}, Vec3{1, 2.1, 2.8}, Vec3{-0.3, 3.5, 4.0}, Vec3{9, -8, 7}}) {
    constexpr int count = 20000;
    double nearest = 1e300;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / count;
      const Vec3 ring = Vec3{1, 2, 3} + 2.0 * (std::cos(angle) * first + std::sin(angle) * second);
      nearest = std::min(nearest, length(x - ring));
    }
    // A place of the ring is at most δ = π/count from one of them: the squares of the two distances differ by
    // 2·|e⊥|·R·(1 − cos δ) ≤ |e⊥|·R·δ².
    const double found = signed_distance(torus, x), delta = std::numbers::pi / count;
    EXPECT_LE(found, nearest - 0.5 + 1e-14);
    EXPECT_GE(found, nearest - 0.5 - length(x - Vec3{1, 2, 3}) * 2.0 * delta * delta / (2.0 * (found + 0.5)));
  }
}

TEST(Torus, HasNormalsOnItsAxisAndOnItsRing) {
  const TerrainSettings settings = {.shape = TerrainShape::torus,
                                    .geometry = {{"center", Vec3{1, 2, 3}}, {"axis", Vec3{0, 0, 5}}}};
  const Terrain torus = make_terrain(settings, {});
  const Vec3 axis = {0, 0, 1};
  const auto on_ring = terrain_gap(torus, {4, 2, 3});
  EXPECT_EQ(on_ring.n, axis);
  EXPECT_EQ(on_ring.d, -1.2);
  const auto at_center = terrain_gap(torus, {1, 2, 3});
  EXPECT_EQ(at_center.n, axis);
  EXPECT_EQ(at_center.d, 3.0 - 1.2);
  EXPECT_EQ(terrain_gap(torus, {1, 2, 7}).n, axis);
  EXPECT_EQ(terrain_gap(torus, {1, 2, 7}).d, 5.0 - 1.2);
  EXPECT_EQ(terrain_gap(torus, {1, 2, -1}).n, -axis);
}

// The plane y = 0 over the bowl around (2, 6.364, 1) of radius 9.
TEST(PlaneWithHole, IsThePlaneOrTheBowlWhicheverIsFurther) {
  const Terrain hole = make_terrain({.shape = TerrainShape::plane_with_hole}, {});
  const auto on_plane = terrain_gap(hole, {20, -0.5, 1});
  EXPECT_EQ(on_plane.d, -0.5);
  EXPECT_EQ(on_plane.n, (Vec3{0, 1, 0}));
  const auto in_bowl = terrain_gap(hole, {2, -2, 1});
  EXPECT_DOUBLE_EQ(in_bowl.d, 9.0 - 8.364);
  EXPECT_EQ(in_bowl.n, (Vec3{0, 1, 0}));
  const auto at_wall = terrain_gap(hole, {2.0 + 6.0, -0.5, 1});
  EXPECT_DOUBLE_EQ(at_wall.d, 9.0 - std::hypot(6.0, 6.864));
  EXPECT_LT(at_wall.n.x, 0.0) << "inwards";
  // Both distances 1: the plane's normal counts.
  const TerrainSettings level = {.shape = TerrainShape::plane_with_hole,
                                 .geometry = {{"center", Vec3{0, 1, 0}}, {"radius", 4.0}}};
  const auto tie = terrain_gap(make_terrain(level, {}), {3, 1, 0});
  EXPECT_EQ(tie.d, 1.0);
  EXPECT_EQ(tie.n, (Vec3{0, 1, 0}));
  // The bowl's center counts for nothing but a direction.
  const auto center = terrain_gap(make_terrain(level, {}), {0, 1, 0});
  EXPECT_EQ(center.d, 4.0);
  EXPECT_EQ(center.n, (Vec3{0, 1, 0}));
}

}  // namespace
}  // namespace aspic
