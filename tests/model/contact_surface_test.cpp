// What contact between bodies takes of their surfaces.
#include "model/contact_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "support/lattice_bodies.h"

namespace aspic {
namespace {

Model box(const std::array<int, 3>& particles) {
  CubeSettings cube;
  cube.particles = particles;
  return test::build_alone<&ModelSettings::cubes>(cube);
}

TEST(ContactSurface, OfACubeHasPointsOnItsEdges) {
  for (const int n : {2, 3, 7}) {
    const ContactSurfaces all = contact_surfaces(box({n, n, n}));
    const auto m = static_cast<std::uint32_t>(n - 1);
    ASSERT_EQ(all.bodies.size(), 1u);
    EXPECT_EQ(all.bodies[0].surface_particles, 6 * m * m + 2);
    EXPECT_EQ(all.bodies[0].point_count, 6 * m * m + 2 + 24 * m);
    EXPECT_EQ(all.points.size(), all.bodies[0].point_count);
    EXPECT_EQ(all.triangles.size(), 12 * m * m);
    EXPECT_TRUE(all.bodies[0].closed);
  }
}

// Against the rest positions: points of edges lie on the edges of the box, a third of a spacing apart.
TEST(ContactSurface, PointsOnEdgesLieOnTheEdgesOfABox) {
  const Model model = box({4, 3, 5});
  const ContactSurfaces all = contact_surfaces(model);
  const double s = all.bodies[0].spacing;
  EXPECT_DOUBLE_EQ(s, 1.0);
  std::set<std::array<long, 3>> places;
  for (const SurfacePoint& point : all.points) {
    if (point.single()) continue;
    const Vec3 a = model.initial_position[point.carrier[0]] - Vec3{0, 9, 0},
               b = model.initial_position[point.carrier[1]] - Vec3{0, 9, 0};
    const Vec3 at = point.weight[0] * a + point.weight[1] * b;
    EXPECT_NEAR(length(b - a), s, 1e-12);
    const int outer = (std::abs(std::abs(at.x) - 1.5) < 1e-12) + (std::abs(std::abs(at.y) - 1.0) < 1e-12) +
                      (std::abs(std::abs(at.z) - 2.0) < 1e-12);
    EXPECT_EQ(outer, 2);
    EXPECT_EQ(all.points[point.own[0]].carrier[0], point.carrier[0]);
    EXPECT_EQ(all.points[point.own[1]].carrier[0], point.carrier[1]);
    places.insert(
        {std::lround(3 * at.x / s * 2), std::lround(3 * at.y / s * 2), std::lround(3 * at.z / s * 2)});
  }
  EXPECT_EQ(places.size(), 2u * 4 * (3 + 2 + 4));
}

TEST(ContactSurface, TrianglesFaceOutwardsAndAreKnownAtTheirCorners) {
  const Model model = box({3, 4, 2});
  const ContactSurfaces all = contact_surfaces(model);
  std::vector<std::uint32_t> met(all.triangles.size());
  for (std::uint32_t p = 0; p < all.points.size(); ++p) {
    EXPECT_EQ(all.triangles_at(p).empty(), !all.points[p].single());
    EXPECT_TRUE(std::ranges::is_sorted(all.triangles_at(p)));
    for (const std::uint32_t t : all.triangles_at(p)) {
      EXPECT_EQ(std::ranges::count(all.triangles[t].corner, all.points[p].carrier[0]), 1);
      ++met[t];
    }
  }
  for (std::size_t t = 0; t < met.size(); ++t) {
    EXPECT_EQ(met[t], 3u);
    const auto x = [&](std::size_t n) { return model.initial_position[all.triangles[t].corner[n]]; };
    EXPECT_GT(dot(cross(x(1) - x(0), x(2) - x(0)), x(0) - Vec3{0, 9, 0}), 0.0);
    EXPECT_LT(all.triangles[t].side, 6u);
  }
}

// An inner edge of an L is as sharp as an outer one; where a flat side merely ends at a hole there is one
// too.
TEST(ContactSurface, EdgesOfANotchAreSharp) {
  ModelSettings settings;
  settings.cubes.emplace_back();
  const Model model = test::with_cells(settings, test::lattice_of("x,x;x,."));
  const ContactSurfaces all = contact_surfaces(model);
  // A prism over an L: twelve sides of length one around both ends, six edges along it, of one cell each.
  const std::uint32_t edges = 2 * 8 + 6;
  EXPECT_EQ(all.bodies[0].point_count - all.bodies[0].surface_particles, 2 * edges);
}

TEST(ContactSurface, OfAClothIsOpenAndEndsInEdges) {
  ClothSettings cloth;
  cloth.particles = {5, 4};
  const ContactSurfaces all = contact_surfaces(test::build_alone<&ModelSettings::cloths>(cloth));
  EXPECT_FALSE(all.bodies[0].closed);
  EXPECT_EQ(all.bodies[0].surface_particles, 20u);
  EXPECT_EQ(all.bodies[0].point_count, 20u + 2 * 2 * (4 + 3));
  EXPECT_EQ(all.triangles.size(), 2u * 4 * 3);
}

TEST(ContactSurface, PairsHaveTheirConstants) {
  ContactBody soft, hard;
  soft = {.stiffness = 7.3125 * 2000, .mass = 1.0, .spacing = 0.4};
  hard = {.stiffness = 3 * 7.3125 * 2000, .mass = 3.0, .spacing = 0.2};
  ContactSettings contact;
  contact.body_damping = 0.5;
  const ContactPair pair = contact_pair(contact, soft, hard, false);
  EXPECT_DOUBLE_EQ(pair.stiffness, 1.5 * 7.3125 * 2000);             // 2·1·3/(1 + 3)
  EXPECT_DOUBLE_EQ(pair.damping, std::sqrt(pair.stiffness * 0.75));  // 1/(1/1 + 1/3)
  EXPECT_DOUBLE_EQ(pair.spacing, 0.2);
  EXPECT_DOUBLE_EQ(pair.reach, 0.02);
  EXPECT_DOUBLE_EQ(pair.depth, 0.05);
  EXPECT_DOUBLE_EQ(pair.margin, 0.3);
  EXPECT_DOUBLE_EQ(contact_pair(contact, soft, soft, true).depth, 0.1);
  hard.closed = false;
  EXPECT_DOUBLE_EQ(contact_pair(contact, soft, hard, false).reach, 0.05);
  EXPECT_DOUBLE_EQ(contact_pair(contact, hard, soft, false).reach, 0.02);
}

TEST(ContactSurface, IsBuiltOnlyWhenContactIsPossible) {
  ModelSettings settings;
  settings.cubes.resize(1);
  settings.contact.bodies = true;
  EXPECT_FALSE(has_body_contact(test::build(settings))) << "there is nothing else";
  settings.goal_nets.resize(1);
  EXPECT_TRUE(has_body_contact(test::build(settings)));
  settings.contact.bodies = false;
  EXPECT_FALSE(has_body_contact(test::build(settings)));
  settings.contact.self = true;
  EXPECT_TRUE(has_body_contact(test::build(settings)));
}

}  // namespace
}  // namespace aspic
