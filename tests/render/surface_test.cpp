#include "render/surface.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>

#include "render/software_rasterizer.h"
#include "render/terrain_mesh.h"
#include "support/lattice_bodies.h"
#include "support/model_building.h"

namespace aspic {
namespace {

TEST(Surface, CubeHasAClosedSkinThatFacesOutwards) {
  const int n = 5;
  const Model model = test::build(test::cube_on_plane(n));
  const Surface surface = make_surface(model);
  ASSERT_EQ(surface.indices.size(), 6u * 2 * 3 * (n - 1) * (n - 1));
  // Each of the six faces has its own.
  ASSERT_EQ(surface.fan_vertex.size(), 6u * n * n);
  ASSERT_EQ(surface.corners.size(), surface.indices.size());
  for (std::size_t i = 0; i < surface.corners.size(); ++i)
    ASSERT_EQ(surface.fan_vertex[surface.corners[i]], surface.indices[i]);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (std::size_t t = 0; t < surface.indices.size(); t += 3) {
    const std::array<std::uint32_t, 3> corner = {surface.indices[t], surface.indices[t + 1],
                                                 surface.indices[t + 2]};
    for (std::size_t i = 0; i < 3; ++i) ++edges[{corner[i], corner[(i + 1) % 3]}];
    const auto& x = model.initial_position;
    volume += dot(x[corner[0]], cross(x[corner[1]], x[corner[2]])) / 6.0;
  }
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << "an edge borders on nothing";
  }
  EXPECT_NEAR(volume, 64.0, 1e-9);  // edge 4 m, by the divergence theorem: positive means outwards
}

TEST(Surface, FansHoldThreeQuadsAtCornersFourElsewhereTheirOwnFirst) {
  const int n = 4;
  const Model model = test::build(test::cube_on_plane(n));
  const Surface surface = make_surface(model);
  std::map<std::uint32_t, int> with;  // own quads → vertices
  for (std::size_t i = 0; i < surface.fan_vertex.size(); ++i) {
    const std::uint32_t quads = surface.fan_start[i + 1] - surface.fan_start[i],
                        own = surface.fan_own[i] - surface.fan_start[i];
    ++with[own];
    EXPECT_EQ(quads, own == 1 ? 3u : 4u);
    const auto& x = model.initial_position;
    std::optional<Vec3> face;
    for (std::uint32_t q = surface.fan_start[i]; q < surface.fan_start[i + 1]; ++q) {
      const Vec3 at = x[surface.fan_vertex[i]];
      const std::size_t pair = std::size_t{2} * q;
      const Vec3 normal = cross(x[surface.fan[pair]] - at, x[surface.fan[pair + 1]] - at);
      const Vec3 unit = normal / length(normal);
      if (!face) face = unit;
      // Those of other patches stand square on it.
      EXPECT_NEAR(dot(*face, unit), q < surface.fan_own[i] ? 1.0 : 0.0, 1e-12);
    }
  }
  EXPECT_EQ(with[1], 6 * 4);
  EXPECT_EQ(with[2], 6 * 4 * (n - 2));
  EXPECT_EQ(with[4], 6 * (n - 2) * (n - 2));
}

TEST(Surface, ACoarseSkinIsClosedAndKeepsTheCorners) {
  const Model model = test::build(test::cube_on_plane(30));
  const Surface surface = make_surface(model);
  ASSERT_EQ(surface.coarse_parts.size(), 1u);
  const Surface::Part part = surface.coarse_parts[0];
  EXPECT_EQ(part.index_count, 6u * 6 * software::coarse_quads * software::coarse_quads);
  EXPECT_EQ(part.first_index, surface.parts[0].index_count);
  const std::set<std::uint32_t> skin(surface.fan_vertex.begin(), surface.fan_vertex.end());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (std::uint32_t t = part.first_index; t < part.first_index + part.index_count; t += 3) {
    const std::uint32_t* const corner = &surface.indices[t];
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(skin.contains(corner[i])) << "a vertex without a normal";
      ++edges[{corner[i], corner[(i + 1) % 3]}];
    }
    const auto& x = model.initial_position;
    volume += dot(x[corner[0]], cross(x[corner[1]], x[corner[2]])) / 6.0;
  }
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << "an edge borders on nothing";
  }
  EXPECT_NEAR(volume, 64.0, 1e-9);
}

TEST(Surface, SkinsOfBoxesAndOfBodiesWithEmptyCellsAreClosed) {
  ModelSettings box = test::cube_on_plane(2);
  box.cubes[0].particles = {41, 6, 11};  // 4 m, 0.5 m and 1 m
  ModelSettings ring = test::cube_on_plane(2);
  ring.cubes[0].edge_length = 3.0;
  const std::pair<Model, double> bodies[] = {
      {test::build(box), 2.0}, {test::with_cells(ring, test::lattice_of("x,x,x;x,.,x;x,x,x")), 8.0}};
  for (const auto& [model, expected] : bodies) {
    const Surface surface = make_surface(model);
    for (const Surface::Part& part : {surface.parts[0], surface.coarse_parts[0]}) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      double volume = 0.0;
      for (std::uint32_t t = part.first_index; t < part.first_index + part.index_count; t += 3) {
        const std::uint32_t* const corner = &surface.indices[t];
        for (std::size_t i = 0; i < 3; ++i) ++edges[{corner[i], corner[(i + 1) % 3]}];
        const auto& x = model.initial_position;
        volume += dot(x[corner[0]], cross(x[corner[1]], x[corner[2]])) / 6.0;
      }
      for (const auto& [edge, times] : edges) EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
      EXPECT_NEAR(volume, expected, 1e-9);
    }
  }
  const Surface surface = make_surface(bodies[0].first);
  const auto along = [](std::uint32_t quads) { return std::min(quads, software::coarse_quads); };
  EXPECT_EQ(surface.coarse_parts[0].index_count,
            6 * 2 * (along(40) * along(5) + along(5) * along(10) + along(10) * along(40)));
}

TEST(Surface, ASmallBodyHasOneSkin) {
  const Surface surface = make_surface(test::build(test::cube_on_plane(17)));
  EXPECT_EQ(surface.coarse_parts[0].first_index, surface.parts[0].first_index);
  EXPECT_EQ(surface.coarse_parts[0].index_count, surface.indices.size());
}

TEST(TerrainMesh, SphereIsClosedAndFacesOutwards) {
  const Mesh mesh = sphere_mesh(32, 64);
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::array<Vec3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& v = mesh.vertices[mesh.indices[t + i]];
      x[i] = {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
      EXPECT_NEAR(length(x[i]), 1.0, 1e-6);
    }
    volume += dot(x[0], cross(x[1], x[2])) / 6.0;
  }
  // An inscribed mesh of angular step δ has volume 4π/3·(1 − O(δ²)), δ = π/32.
  const double ball = 4.0 / 3.0 * 3.14159265358979;
  EXPECT_LT(volume, ball);
  EXPECT_GT(volume, ball * (1.0 - 0.0097));
}

TEST(TerrainMesh, GroundRepeatsWithoutASeam) {
  const int size = 128;
  const auto texels = ground_texels(size);
  ASSERT_EQ(texels.size(), 4u * size * size);
  const auto red = [&](int row, int column) {
    return std::to_integer<int>(texels[4 * static_cast<std::size_t>(row * size + column)]);
  };
  // A joint runs along both edges: its two sides differ by no more than neighboring tiles' shades do.
  for (int i = 0; i < size; ++i) {
    EXPECT_NEAR(red(i, 0), red(i, size - 1), 48);
    EXPECT_NEAR(red(0, i), red(size - 1, i), 48);
  }
  std::set<int> shades;
  for (const std::byte b : texels) shades.insert(std::to_integer<int>(b));
  EXPECT_GT(shades.size(), 30u);
}

}  // namespace
}  // namespace aspic
