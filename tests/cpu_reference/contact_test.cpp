#include <gtest/gtest.h>

#include "cpu_reference/ground.h"
#include "model/terrain.h"
#include "physics/terrain/ground.h"

namespace aspic::physics {
namespace {

using V = Vector<double>;

Ground<double> round(TerrainShape shape) {
  TerrainSettings settings;
  settings.shape = shape;
  settings.geometry["center"] = Vec3{1.0, 2.0, 3.0};
  settings.geometry["radius"] = 2.0;
  return Ground<double>(make_terrain(settings, ContactSettings{}));
}

TEST(Gap, PlaneSphereAndBowl) {
  const auto flat = gap<double>(plane(), {5, -0.25, 7});
  EXPECT_EQ(flat.d, -0.25);
  EXPECT_EQ(flat.n, V(0, 1, 0));
  const auto ball = gap<double>(round(TerrainShape::sphere), {1, 2, 6});
  EXPECT_EQ(ball.d, 1.0);
  EXPECT_EQ(ball.n, V(0, 0, 1));
  const auto bowl = gap<double>(round(TerrainShape::bowl), {1, 0.5, 3});
  EXPECT_EQ(bowl.d, 0.5);
  EXPECT_EQ(bowl.n, V(0, 1, 0));
}

TEST(Gap, DistanceAloneHasTheSameBits) {
  const V x(0.3, -1.7, 2.9);
  EXPECT_EQ(distance<double>(plane(), x), gap<double>(plane(), x).d);
  for (const TerrainShape shape : {TerrainShape::sphere, TerrainShape::bowl})
    EXPECT_EQ(distance<double>(round(shape), x), gap<double>(round(shape), x).d);
}

TEST(Gap, AtACenterTheNormalPointsUp) {
  for (const TerrainShape shape : {TerrainShape::sphere, TerrainShape::bowl}) {
    const auto center = gap<double>(round(shape), {1, 2, 3});
    EXPECT_EQ(center.n, V(0, 1, 0));
    EXPECT_EQ(center.d, shape == TerrainShape::bowl ? 2.0 : -2.0);
  }
}

TEST(BounceSpeed, FixedAndMovableTerrain) {
  EXPECT_EQ(bounce_speed<double>(plane(0.5), 1.0, -4.0), 2.0);
  // The slide's sphere: e = 1, M = 10, m = 1 gives −9/11·u.
  EXPECT_DOUBLE_EQ(bounce_speed<double>(plane(1.0, 0.0, 10.0), 1.0, -11.0), 9.0);
  // A heavy particle on a light terrain would go on downwards: B is never negative.
  EXPECT_EQ(bounce_speed<double>(plane(0.1, 0.0, 1.0), 5.0, -3.0), 0.0);
}

TEST(Course, ResponseIsTheAssignmentsFormula) {
  V v(3, -4, 1);
  respond_course<double>(plane(), 0.01, 1.0, {0, 0.005, 0}, v);
  EXPECT_EQ(v, V(3, 2, 1));
  V far(3, -4, 1);
  respond_course<double>(plane(), 0.01, 1.0, {0, 0.011, 0}, far);
  EXPECT_EQ(far, V(3, -4, 1));
}

TEST(Course, ContactForceResistsAndRubs) {
  Model model;
  model.contact.distance = 0.01;
  model.contact.resting_speed = 0.01;
  const ContactConstants<double> contact(model);
  const V f = with_contact_force<double>(plane(), contact, {0, 0, 0}, {2, 0.005, 0}, {1, -8, 0});
  EXPECT_EQ(f, V(1 - 0.25 * 8 * 2, 0, 0));
  const V pulled = with_contact_force<double>(plane(), contact, {0, 0, 0}, {2, 0, 0}, {1, 8, 0});
  EXPECT_EQ(pulled, V(1, 8, 0));
  const V fast = with_contact_force<double>(plane(), contact, {0, 0, 0}, {2, -0.02, 0}, {1, -8, 0});
  EXPECT_EQ(fast, V(1, -8, 0));
}

}  // namespace
}  // namespace aspic::physics
