// The rods of a body: a goal net's follow the particles that they hold.
#include "render/rods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/model_building.h"

namespace aspic {
namespace {

Vec3 three(const std::array<float, 4>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return length(p - (a + t * (b - a)));
}

TEST(Rods, OfAGoalAreTubesAlongPostsAndTheTopsPerimeter) {
  ModelSettings settings;
  GoalNetSettings net;
  net.size = {2.0, 3.0, 8.0};
  net.position = {1.0, 2.0, -3.0};
  settings.goal_nets.push_back(net);
  const Mesh mesh = rod_mesh(test::build(settings));
  ASSERT_FALSE(mesh.indices.empty());
  ASSERT_EQ(mesh.vertices.size(), mesh.normals.size());
  const auto corner = [&](int x, int y, int z) { return net.position + Vec3{x * 1.0, y * 1.5, z * 4.0}; };
  std::vector<std::array<Vec3, 2>> segments;
  for (const int s : {-1, 1}) {
    for (const int t : {-1, 1}) segments.push_back({corner(s, -1, t), corner(s, 1, t)});
    segments.push_back({corner(s, 1, -1), corner(s, 1, 1)});
    segments.push_back({corner(-1, 1, s), corner(1, 1, s)});
  }
  const double radius = 0.04;  // a fiftieth of the least side
  std::vector<int> near(segments.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(length(three(mesh.normals[i])), 1.0, 1e-6);
    double least = 1e9;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const double d = distance_to_segment(three(mesh.vertices[i]), segments[s][0], segments[s][1]);
      least = std::min(least, d);
      near[s] += d <= radius + 1e-6;
    }
    EXPECT_LE(least, radius + 1e-6);  // single precision at 7 m: 5e-7
  }
  for (const int count : near) EXPECT_GT(count, 0);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3 a = three(mesh.vertices[mesh.indices[i]]), b = three(mesh.vertices[mesh.indices[i + 1]]),
               c = three(mesh.vertices[mesh.indices[i + 2]]);
    const Vec3 n = three(mesh.normals[mesh.indices[i]]) + three(mesh.normals[mesh.indices[i + 1]]) +
                   three(mesh.normals[mesh.indices[i + 2]]);
    EXPECT_GE(dot(cross(b - a, c - a), n), -1e-6) << "triangle " << i / 3;
  }
}

TEST(Rods, AreNoneAtACube) {
  EXPECT_TRUE(rod_mesh(test::build(test::cube_on_plane(3))).indices.empty());
}

}  // namespace
}  // namespace aspic
