#include "mesh/repair_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/split_mix.h"
#include "mesh/shapes.h"
#include "mesh/weld.h"
#include "mesh/winding.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const TriangleMesh& sphere() {
  static const TriangleMesh made = test::sphere_mesh(3, 1.0);
  return made;
}

/// A closed mesh that turns outwards.
void expect_closed(const RepairedMesh& made, double volume) {
  EXPECT_EQ(made.repairs.open_edges, 0u);
  EXPECT_EQ(made.repairs.crowded_edges, 0u);
  EXPECT_NEAR(enclosed_volume(made.mesh), volume, 1e-9);
}

TEST(RepairMesh, GoodMeshStaysAsItIs) {
  const RepairedMesh made = repair_mesh(sphere());
  EXPECT_EQ(made.mesh, sphere());
  EXPECT_EQ(made.repairs, (MeshRepairs{.faces = 1280, .vertices = 642, .patches = 1}));
  EXPECT_THAT(sentences_of(made.repairs), IsEmpty());
}

TEST(RepairMesh, WeldsEqualVertices) {
  const RepairedMesh made = repair_mesh(test::as_soup(sphere()));
  EXPECT_EQ(made.repairs.welded, 3 * 1280 - 642u);
  EXPECT_EQ(made.repairs.vertices, 642u);
  EXPECT_EQ(made.repairs.patches, 1u);
  expect_closed(made, enclosed_volume(sphere()));
}

TEST(RepairMesh, WeldsVerticesThatRoundingMoved) {
  TriangleMesh soup = test::as_soup(sphere());
  SplitMix64 random(1);
  for (Vec3& v : soup.vertices)
    for (int axis = 0; axis < 3; ++axis) v[axis] += 4e-7 * (random.share() - 0.5);
  const RepairedMesh made = repair_mesh(soup);
  EXPECT_EQ(made.repairs.vertices, 642u);
  EXPECT_EQ(made.repairs.open_edges, 0u);
}

// A point far away makes all others lie in few cells of the welder's grid.
TEST(RepairMesh, WeldingTakesItsTimeByThePointsWhereverTheyAre) {
  SplitMix64 random(2);
  std::vector<Vec3> points(200'000);
  for (Vec3& p : points) p = {1e-4 * random.share(), 1e-4 * random.share(), 1e-4 * random.share()};
  points.push_back({1.0, 1.0, 1.0});
  const auto first = weld_points(points, 1e-6);
  EXPECT_EQ(first.front(), 0u);
  EXPECT_EQ(first.back(), points.size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_LE(length(points[i] - points[first[i]]), 1e-6);
}

TEST(RepairMesh, LeavesOutFacesThatAreNotFinite) {
  TriangleMesh mesh = sphere();
  const auto far = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  mesh.vertices.push_back({0.0, std::numeric_limits<double>::infinity(), 0.0});
  mesh.vertices.push_back({0.0, 0.0, -1e200});
  for (std::uint32_t i = 0; i < 3; ++i) mesh.triangles.push_back({0, 1, far + i});
  const RepairedMesh made = repair_mesh(mesh);
  EXPECT_EQ(made.repairs.not_finite, 3u);
  EXPECT_EQ(made.mesh, sphere());
  EXPECT_THAT(sentences_of(made.repairs), ElementsAre("left out 3 faces with a corner that is not finite"));
}

TEST(RepairMesh, LeavesOutFacesWithoutAreaButKeepsWhatTheyConnect) {
  // The upper edge of a box has a vertex in its middle on one side, filled by a face without area.
  TriangleMesh mesh = test::box_mesh({1, 1, 1});
  mesh.vertices.push_back({0.0, 1.0, 1.0});  // 8, between 3 and 7
  std::erase(mesh.triangles, Triangle{2, 3, 7});
  for (const Triangle& t : {Triangle{2, 3, 8}, Triangle{2, 8, 7}, Triangle{3, 7, 8}, Triangle{1, 1, 5}})
    mesh.triangles.push_back(t);
  const RepairedMesh made = repair_mesh(mesh);
  EXPECT_EQ(made.repairs.zero_area, 2u);
  EXPECT_EQ(made.repairs.open_edges, 0u);
  EXPECT_EQ(made.repairs.faces, 13u);
  EXPECT_NEAR(enclosed_volume(made.mesh), 8.0, 1e-12);
}

TEST(RepairMesh, TurnsFacesToAgreeWithTheirNeighbors) {
  for (const double share : {0.1, 0.4, 0.9}) {
    const TriangleMesh turned = test::with_turned(sphere(), share, 3);
    const RepairedMesh made = repair_mesh(turned);
    expect_closed(made, enclosed_volume(sphere()));
    EXPECT_NEAR(static_cast<double>(made.repairs.turned), share * 1280.0, 60.0);
    EXPECT_EQ(made.repairs.patches, 1u);
  }
  EXPECT_THAT(sentences_of(repair_mesh(test::with_turned(sphere(), 1.0, 3)).repairs),
              ElementsAre("turned all faces: the mesh was inside out"));
}

TEST(RepairMesh, TurnsEachPartOutwards) {
  const TriangleMesh mesh =
      test::together(test::with_turned(sphere(), 1.0, 1), test::sphere_mesh(2, 1.0, {3, 0, 0}));
  const RepairedMesh made = repair_mesh(mesh);
  EXPECT_EQ(made.repairs.patches, 2u);
  EXPECT_EQ(made.repairs.turned, 1280u);
  EXPECT_EQ(made.repairs.cavities, 0u);
  const WindingTree tree(made.mesh);
  EXPECT_NEAR(tree.at({}), 1.0, 0.01);
  EXPECT_NEAR(tree.at({3, 0, 0}), 1.0, 0.01);
}

// Shells in shells: what the file turns against its holder is hollow, also where all of it is inside out.
TEST(RepairMesh, KeepsCavities) {
  const TriangleMesh inner = test::with_turned(test::sphere_mesh(2, 0.7), 1.0, 1),
                     core = test::sphere_mesh(2, 0.3);
  const TriangleMesh shells = test::together(test::together(core, inner), sphere());
  for (const TriangleMesh& mesh : {shells, test::with_turned(shells, 1.0, 1)}) {
    const RepairedMesh made = repair_mesh(mesh);
    EXPECT_EQ(made.repairs.cavities, 1u);
    const WindingTree tree(made.mesh);
    EXPECT_NEAR(tree.at({0, 0.8, 0}), 1.0, 0.01);
    EXPECT_NEAR(tree.at({0, 0.5, 0}), 0.0, 0.01);
    EXPECT_NEAR(tree.at({0, 0.1, 0}), 1.0, 0.01);
  }
  // Turned alike, one inside the other is no cavity.
  EXPECT_EQ(repair_mesh(test::together(sphere(), core)).repairs.cavities, 0u);
}

TEST(RepairMesh, OfDoubledFacesOneStays) {
  TriangleMesh doubled = test::together(sphere(), sphere());
  RepairedMesh made = repair_mesh(doubled);
  EXPECT_EQ(made.repairs.doubled, 1280u);
  expect_closed(made, enclosed_volume(sphere()));
  // A surface with two sides, as it is drawn without culling: one of them stays.
  doubled = test::together(sphere(), test::with_turned(sphere(), 1.0, 1));
  made = repair_mesh(doubled);
  EXPECT_EQ(made.repairs.doubled, 1280u);
  expect_closed(made, enclosed_volume(sphere()));
}

TEST(RepairMesh, WallsInsideGo) {
  // Two boxes with a common side of the same triangles, which both have.
  TriangleMesh left = test::box_mesh({1, 1, 1}, {-1, 0, 0}), right = test::box_mesh({1, 1, 1}, {1, 0, 0});
  for (Triangle& t : left.triangles)
    if (t == Triangle{4, 6, 7}) t = {4, 6, 5};
  for (Triangle& t : left.triangles)
    if (t == Triangle{4, 7, 5}) t = {6, 7, 5};
  for (Triangle& t : right.triangles)
    if (t == Triangle{0, 1, 3}) t = {0, 1, 2};
  for (Triangle& t : right.triangles)
    if (t == Triangle{0, 3, 2}) t = {1, 3, 2};
  const RepairedMesh made = repair_mesh(test::together(left, right));
  EXPECT_EQ(made.repairs.doubled, 4u);
  EXPECT_EQ(made.repairs.patches, 1u);
  expect_closed(made, 16.0);
}

TEST(RepairMesh, CountsHolesAndWhatCannotAgree) {
  TriangleMesh open = sphere();
  open.triangles.pop_back();
  EXPECT_EQ(repair_mesh(open).repairs.open_edges, 3u);
  // A strip of triangles whose ends are joined with a half turn.
  TriangleMesh strip;
  constexpr int n = 16;
  for (int i = 0; i < n; ++i) {
    const double u = 2.0 * 3.14159265358979 * i / n;
    for (const double s : {-0.3, 0.3})
      strip.vertices.push_back({(1.0 + s * std::cos(u / 2)) * std::cos(u), s * std::sin(u / 2),
                                (1.0 + s * std::cos(u / 2)) * std::sin(u)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, b, d});
    strip.triangles.push_back({a, d, c});
  }
  EXPECT_EQ(repair_mesh(strip).repairs.twisted_edges, 1u);
}

TEST(RepairMesh, NothingMayBeLeft) {
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_EQ(repair_mesh(flat).repairs.zero_area, 1u);
  EXPECT_THAT(repair_mesh(flat).mesh.triangles, IsEmpty());
  flat.vertices.assign(3, {1, 1, 1});
  EXPECT_THAT(repair_mesh(flat).mesh.triangles, IsEmpty());
  EXPECT_THAT(repair_mesh({}).mesh.vertices, IsEmpty());
}

}  // namespace
}  // namespace aspic
