#include "model/goal_net.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <vector>

#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

Model net_of(const GoalNetSettings& net) {
  return test::build_alone<&ModelSettings::goal_nets>(net);
}

TEST(GoalNet, TheAssignmentsNetHasThePublishedCounts) {
  const ModelCounts counts = count(net_of({}));
  EXPECT_EQ(counts.particles, 1357u);
  EXPECT_EQ(counts.pinned, 211u);
  EXPECT_EQ(counts.structural, 2650u);
  EXPECT_EQ(counts.springs(), 2650u);
}

using NetPoint = std::array<int, 3>;
class NetLattice : public testing::TestWithParam<NetPoint> {
 protected:
  NetLattice() {
    net.particles = GetParam();
    net.size = {2.0, 3.0, 8.0};
    net.position = {1.0, -2.0, 0.5};
    net.shear.stiffness = 100.0;
    net.bending.stiffness = 10.0;
  }
  GoalNetSettings net;
};

// The topology stated again from nothing but sets of points: the faces as sets, springs as those pairs of one
// face's points whose difference is one step, a diagonal or two steps.
TEST_P(NetLattice, IsWhatTheFacesSay) {
  const auto [nw, nh, nl] = net.particles;
  const Model model = net_of(net);
  std::vector<NetPoint> points;
  std::array<std::set<NetPoint>, 4> faces;
  for (int i = 0; i < nw; ++i) {
    for (int j = 0; j < nh; ++j) {
      for (int k = 0; k < nl; ++k) {
        const NetPoint p = {i, j, k};
        const bool on[4] = {i == 0, j == nh - 1, k == 0, k == nl - 1};
        for (std::size_t f = 0; f < 4; ++f) {
          if (on[f]) faces[f].insert(p);
        }
        if (on[0] || on[1] || on[2] || on[3]) points.push_back(p);
      }
    }
  }
  ASSERT_EQ(model.particle_count(), points.size());

  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  std::array<std::set<Pair>, 3> expected, actual;
  for (std::uint32_t a = 0; a < points.size(); ++a) {
    for (std::uint32_t b = a + 1; b < points.size(); ++b) {
      const bool together = std::any_of(faces.begin(), faces.end(), [&](const std::set<NetPoint>& face) {
        return face.contains(points[a]) && face.contains(points[b]);
      });
      if (!together) continue;
      NetPoint d;
      for (std::size_t axis = 0; axis < 3; ++axis) d[axis] = std::abs(points[b][axis] - points[a][axis]);
      std::sort(d.begin(), d.end());
      if (d == NetPoint{0, 0, 1}) expected[0].insert({a, b});
      if (d == NetPoint{0, 1, 1}) expected[1].insert({a, b});
      if (d == NetPoint{0, 0, 2}) expected[2].insert({a, b});
    }
  }
  Pair last = {0, 0};
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    const Pair pair = {spring.a, spring.b};
    EXPECT_LT(last, pair) << "springs must be sorted";
    last = pair;
    EXPECT_TRUE(actual[static_cast<std::size_t>(c.type)].insert(pair).second);
    const double distance = length(model.initial_position[spring.a] - model.initial_position[spring.b]);
    EXPECT_NEAR(c.rest_length, distance, 16 * 2.3e-16 * 10.0);
  }
  EXPECT_EQ(actual, expected);

  for (std::uint32_t p = 0; p < points.size(); ++p) {
    const auto [i, j, k] = points[p];
    const bool top_edge = j == nh - 1 && (i == 0 || i == nw - 1 || k == 0 || k == nl - 1);
    const bool foot = j == 0 && (i == 0 || k == 0 || k == nl - 1);
    const bool post = (i == 0 || i == nw - 1) && (k == 0 || k == nl - 1);
    EXPECT_EQ(model.inverse_mass[p] == 0.0, top_edge || foot || post) << i << ' ' << j << ' ' << k;
    const Vec3 at = {net.position.x + (static_cast<double>(i) / (nw - 1) - 0.5) * net.size.x,
                     net.position.y + (static_cast<double>(j) / (nh - 1) - 0.5) * net.size.y,
                     net.position.z + (static_cast<double>(k) / (nl - 1) - 0.5) * net.size.z};
    EXPECT_LT(length(model.initial_position[p] - at), 16 * 2.3e-16 * 10.0);
    EXPECT_EQ(net_index(net.particles, i, j, k), p);
  }

  const ModelCounts predicted = goal_net_counts(net), counted = count(model);
  EXPECT_EQ(predicted.particles, counted.particles);
  EXPECT_EQ(predicted.pinned, counted.pinned);
  EXPECT_EQ(predicted.structural, counted.structural);
  EXPECT_EQ(predicted.shear, counted.shear);
  EXPECT_EQ(predicted.bending, counted.bending);
}

// Two points along an axis make faces neighbors, three let bending springs reach across: both must not join
// points of different faces.
INSTANTIATE_TEST_SUITE_P(Sizes, NetLattice,
                         testing::Values(NetPoint{10, 20, 35}, NetPoint{2, 2, 2}, NetPoint{3, 3, 3},
                                         NetPoint{2, 5, 3}, NetPoint{4, 2, 2}, NetPoint{3, 4, 2},
                                         NetPoint{5, 3, 7}));

TEST(GoalNet, CordReachesEverySpring) {
  GoalNetSettings net;
  net.cord = true;
  net.shear.stiffness = 5.0;
  for (const SpringClass& c : net_of(net).spring_classes) EXPECT_TRUE(c.cord);
  net.cord = false;
  for (const SpringClass& c : net_of(net).spring_classes) EXPECT_FALSE(c.cord);
}

TEST(GoalNet, StandsBehindTheCubesInTheGlobalIndex) {
  ModelSettings settings = test::cube_on_plane(3);
  settings.goal_nets.resize(2);
  settings.goal_nets[0].particles = {3, 4, 5};
  const Model model = test::build(settings);
  ASSERT_EQ(model.bodies.size(), 3u);
  EXPECT_EQ(model.bodies[1].style, SurfaceStyle::cords);
  EXPECT_TRUE(surface_of(model.bodies[1]).quads.empty()) << "nothing is drawn between its cords";
  // Meshes of the back, the top and the two sides, which touch other bodies.
  EXPECT_EQ(model.bodies[1].listed_surface.quads.size(), 3u * 4 + 4 * 2 + 2 * (2 * 3));
  EXPECT_EQ(model.bodies[1].listed_surface.groups.size(), 4u);
  EXPECT_EQ(model.bodies[1].rods.size(), 8u) << "four posts and the bars around the top";
  EXPECT_EQ(model.bodies[1].first_particle, 27u);
  EXPECT_EQ(model.bodies[2].first_particle, 27u + model.bodies[1].particle_count);
  EXPECT_EQ(model.particle_count(), 27u + model.bodies[1].particle_count + 1357u);
  const std::vector<Spring> springs = all_springs(model);
  EXPECT_TRUE(std::is_sorted(springs.begin(), springs.end(), [](const Spring& a, const Spring& b) {
    return std::tie(a.a, a.b) < std::tie(b.a, b.b);
  }));
}

TEST(GoalNet, HasNoParticleInItsFrontAndBottom) {
  const NetPoint n = {4, 5, 6};
  EXPECT_FALSE(net_index(n, 3, 2, 2).has_value());
  EXPECT_FALSE(net_index(n, 2, 0, 3).has_value());
  EXPECT_FALSE(net_index(n, -1, 0, 0).has_value());
  EXPECT_FALSE(net_index(n, 0, 0, 6).has_value());
}

}  // namespace
}  // namespace aspic
