#include "model/skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/split_mix.h"
#include "mesh/shapes.h"
#include "mesh/voxelize.h"
#include "model/skin_text.h"

namespace aspic {
namespace {

const VoxelizedMesh& torus() {
  static const VoxelizedMesh made = *voxelize(test::torus_mesh(60, 30, 1.0, 0.4), {.cells = 16}, "torus");
  return made;
}

std::vector<Vec3> corner_positions(const OccupancyGrid& grid) {
  const Lattice lattice = lattice_of(grid);
  std::vector<Vec3> positions;
  for (std::size_t p = 0; p < lattice.points(); ++p) {
    const auto [i, j, k] = lattice.place(p);
    if (lattice.has_particle({i, j, k}))
      positions.push_back(grid.origin + grid.size * Vec3{static_cast<double>(i), static_cast<double>(j),
                                                         static_cast<double>(k)});
  }
  return positions;
}

/// Vertices in edges of cells from the first corner.
std::vector<Vec3> in_cells(const OccupancyGrid& grid, std::span<const Vec3> vertices) {
  std::vector<Vec3> made;
  for (const Vec3& v : vertices) made.push_back((v - grid.origin) / grid.size);
  return made;
}

struct Bound {
  SkinBinding binding;
  std::vector<std::array<std::uint32_t, 8>> corners;
  explicit Bound(const VoxelizedMesh& made) {
    const Lattice lattice = lattice_of(made.grid);
    binding = bind_skin(lattice, in_cells(made.grid, made.skin.vertices));
    corners = skin_corners(binding, lattice, particle_numbers(lattice));
  }
};

TEST(Skin, AtRestLiesWhereTheMeshIs) {
  const Bound bound(torus());
  EXPECT_EQ(bound.binding.clamped, 0u);
  const auto at_rest = skin_positions(bound.binding, bound.corners, corner_positions(torus().grid));
  ASSERT_EQ(at_rest.size(), torus().skin.vertices.size());
  for (std::size_t v = 0; v < at_rest.size(); ++v)
    EXPECT_LT(length(at_rest[v] - torus().skin.vertices[v]), 1e-14);
}

TEST(Skin, AffineMotionOfTheLatticeMovesItExactly) {
  const Bound bound(torus());
  SplitMix64 random(1);
  const auto one = [&] { return 4.0 * random.share() - 2.0; };
  for (int trial = 0; trial < 5; ++trial) {
    Vec3 rows[3], moved;
    for (Vec3& row : rows) row = {one(), one(), one()};
    moved = {one(), one(), one()};
    const auto map = [&](const Vec3& p) {
      return moved + Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)};
    };
    std::vector<Vec3> corners = corner_positions(torus().grid);
    for (Vec3& c : corners) c = map(c);
    const auto skin = skin_positions(bound.binding, bound.corners, corners);
    // Weights of up to 1½³ in each of eight terms of up to 10 m.
    for (std::size_t v = 0; v < skin.size(); ++v)
      ASSERT_LT(length(skin[v] - map(torus().skin.vertices[v])), 8 * 3.4 * 10 * 2.3e-16 * 4);
  }
}

// What is asked of a binding, found by trying every full cell.
TEST(Skin, VertexIsBoundToTheCellThatItIsLeastOutsideOf) {
  const OccupancyGrid& grid = torus().grid;
  SplitMix64 random(2);
  std::vector<Vec3> points(400);
  for (Vec3& p : points)
    p = {3.2 * random.share() - 1.6, 1.2 * random.share() - 0.6, 3.2 * random.share() - 1.6};
  const SkinBinding binding = bind_skin(lattice_of(grid), in_cells(grid, points));
  std::size_t clamped = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3 u = (points[n] - grid.origin) / grid.size;
    double least = 1e300;
    for (std::size_t c = 0; c < grid.full.size(); ++c) {
      if (grid.full[c] == 0) continue;
      const auto [i, j, k] = grid.place(c);
      const Vec3 t = u - Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
      double most = 0.0;
      for (int axis = 0; axis < 3; ++axis) most = std::max({most, -t[axis], t[axis] - 1.0});
      least = std::min(least, most);
    }
    const SkinVertex& v = binding.vertices[n];
    ASSERT_TRUE(grid.is_full(v.cell[0], v.cell[1], v.cell[2]));
    double most = 0.0;
    for (int axis = 0; axis < 3; ++axis) most = std::max({most, -v.at[axis], v.at[axis] - 1.0});
    if (least > 0.5) {
      ++clamped;
      EXPECT_EQ(most, 0.5);
    } else {
      EXPECT_NEAR(most, least, 1e-12);
    }
  }
  EXPECT_EQ(binding.clamped, clamped);
  EXPECT_GT(clamped, 20u);
}

TEST(Skin, WeightsAreTrilinear) {
  EXPECT_EQ(corner_weights({0.0, 0.0, 0.0})[0], 1.0);
  EXPECT_EQ(corner_weights({1.0, 0.0, 0.0})[4], 1.0);
  EXPECT_EQ(corner_weights({1.0, 1.0, 1.0})[7], 1.0);
  for (const Vec3& at : {Vec3{0.3, 0.9, 0.2}, Vec3{-0.5, 1.5, 1.25}}) {
    const auto weights = corner_weights(at);
    EXPECT_DOUBLE_EQ(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0);
  }
}

TEST(Skin, TextKeepsAMeshToA4096thOfACell) {
  TriangleMesh mesh = test::torus_mesh(30, 15, 9.0, 4.0);
  const std::string text = to_skin_text(mesh);
  const auto read = mesh_of_skin_text(text);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->triangles, mesh.triangles);
  ASSERT_EQ(read->vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LE(std::abs(read->vertices[v][axis] - mesh.vertices[v][axis]), 1.0 / 4096);
  EXPECT_EQ(to_skin_text(*read), text);
  std::string wrapped;
  for (std::size_t at = 0; at < text.size(); ++at) {
    wrapped += text[at];
    if (at % 80 == 79) wrapped += '\n';
  }
  EXPECT_EQ(mesh_of_skin_text(wrapped), read);
}

TEST(Skin, TextThatIsNoMeshIsRefused) {
  const std::string text = to_skin_text(test::box_mesh({1, 2, 3}));
  for (std::size_t cut = 0; cut < text.size(); ++cut)
    EXPECT_FALSE(mesh_of_skin_text(text.substr(0, cut))) << cut;
  EXPECT_FALSE(mesh_of_skin_text(text + "A"));
  EXPECT_FALSE(mesh_of_skin_text(std::string(1, '!').append(text)));
  EXPECT_FALSE(mesh_of_skin_text("________"));
  // A corner that is no vertex: the last number is one more.
  TriangleMesh wrong = test::box_mesh({1, 2, 3});
  wrong.triangles.back()[2] = 8;
  EXPECT_FALSE(mesh_of_skin_text(to_skin_text(wrong)));
  // Numbers at the ends of their range.
  TriangleMesh far;
  far.vertices = {{-100000.0, 0.0, 100000.0}, {100000.0, 0.0, -100000.0}};
  EXPECT_EQ(mesh_of_skin_text(to_skin_text(far)), far);
}

TEST(Skin, NormalsTurnWithTheTriangles) {
  const TriangleMesh sphere = test::sphere_mesh(3, 2.0);
  const auto normals = skin_normals(sphere.vertices, sphere.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v)
    EXPECT_GT(dot(normals[v], sphere.vertices[v]), 2.0 * 0.999);
  std::vector<Vec3> sheared = sphere.vertices;
  for (Vec3& p : sheared) p.x += 0.5 * p.y;
  const auto turned = skin_normals(sheared, sphere.triangles);
  for (std::size_t v = 0; v < turned.size(); ++v) {
    // The normal of a map A is that of A⁻ᵀ.
    const Vec3 x = 0.5 * sphere.vertices[v];
    Vec3 right = {x.x, x.y - 0.5 * x.x, x.z};
    right = right / length(right);
    EXPECT_GT(dot(turned[v], right), 0.99);
  }
  EXPECT_EQ(skin_normals(std::vector<Vec3>(3), std::vector<Triangle>{{0, 1, 2}})[0], Vec3());
}

}  // namespace
}  // namespace aspic
