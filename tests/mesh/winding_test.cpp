#include "mesh/winding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/split_mix.h"
#include "mesh/shapes.h"

namespace aspic {
namespace {

Vec3 random_point(SplitMix64& random, double reach) {
  const auto one = [&] { return reach * (2.0 * random.share() - 1.0); };
  const double x = one(), y = one();
  return {x, y, one()};
}

TEST(Winding, AngleIsThatOfTheCLibrary) {
  SplitMix64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double angle = std::numbers::pi * (2.0 * random.share() - 1.0),
                 size = std::exp(40.0 * random.share() - 20.0);
    const double y = size * std::sin(angle), x = size * std::cos(angle);
    ASSERT_NEAR(angle_of(y, x), std::atan2(y, x), 1e-12) << y << ", " << x;
  }
  EXPECT_EQ(angle_of(0.0, 0.0), 0.0);
  EXPECT_EQ(angle_of(0.0, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(angle_of(1.0, 0.0), std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(angle_of(-1.0, 0.0), -std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(angle_of(0.0, -1.0), std::numbers::pi);
}

// The sides of a cube are a sixth of all directions from its middle; each of their triangles is half of one.
TEST(Winding, SolidAngleOfACubesSideIsASixthOfTheSphere) {
  const Vec3 a = {1, -1, -1}, b = {1, 1, -1}, c = {1, 1, 1};
  EXPECT_NEAR(solid_angle(a, b, c), 4.0 * std::numbers::pi / 12.0, 1e-12);
  EXPECT_NEAR(solid_angle(a, c, b), -4.0 * std::numbers::pi / 12.0, 1e-12);
  EXPECT_EQ(solid_angle({1, 0, 0}, {0, 1, 0}, {-1, -1, 0}), 0.0) << "in the plane";
  EXPECT_EQ(solid_angle({}, a, b), 0.0) << "at a corner";
}

TEST(Winding, IsOneInsideAClosedMeshAndZeroOutside) {
  const TriangleMesh mesh = test::torus_mesh(40, 20, 1.0, 0.4);
  const WindingTree tree(mesh);
  SplitMix64 random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(random, 1.5);
    const double ring = std::hypot(std::hypot(p.x, p.z) - 1.0, p.y);
    if (ring > 0.37 && ring < 0.41) continue;  // between the polygons and the round torus
    const double inside = ring < 0.4 ? 1.0 : 0.0;
    EXPECT_NEAR(winding_number(mesh, p), inside, 1e-9);
    EXPECT_NEAR(tree.at(p), inside, 0.01);
  }
}

// Closed, with holes, and a soup of turned faces: the tree promises a hundredth for each.
TEST(Winding, TreeIsNearTheSumOverAllTriangles) {
  const TriangleMesh sphere = test::sphere_mesh(4, 1.0);
  SplitMix64 random(3);
  for (const TriangleMesh& mesh : {test::without_above(sphere, 0.6), test::without_share(sphere, 0.3, 4),
                                   test::with_turned(test::torus_mesh(60, 30, 0.9, 0.3), 0.4, 5)}) {
    const WindingTree tree(mesh);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random_point(random, 1.3);
      EXPECT_NEAR(tree.at(p), winding_number(mesh, p), 0.01);
    }
  }
}

TEST(Winding, OfNothingIsZero) {
  EXPECT_EQ(WindingTree(TriangleMesh()).at({1.0, 2.0, 3.0}), 0.0);
}

}  // namespace
}  // namespace aspic
