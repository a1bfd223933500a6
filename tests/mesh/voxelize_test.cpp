// Meshes as they come: what of them is inside, and what is told or refused.
#include "mesh/voxelize.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/read_mesh.h"
#include "mesh/shapes.h"
#include "mesh/winding.h"

namespace aspic {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// 5,120 faces in 40³ cells: 64,000 points.
const TriangleMesh& fine_sphere() {
  static const TriangleMesh made = test::sphere_mesh(4, 1.0);
  return made;
}
constexpr int forty = 40;

VoxelizedMesh voxelized(const TriangleMesh& mesh, const VoxelizationSettings& settings = {.cells = forty}) {
  auto made = voxelize(mesh, settings, "a.obj");
  EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message());
  return made ? std::move(*made) : VoxelizedMesh();
}

/// Cells on the wrong side of the sphere's own mesh, which is whole.
std::size_t wrong_cells(const TriangleMesh& damaged) {
  static const VoxelizedMesh right = voxelized(fine_sphere());
  const VoxelizedMesh made = voxelized(damaged);
  EXPECT_EQ(made.grid.cells, right.grid.cells) << "the damage must leave the box";
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < right.grid.full.size(); ++i)
    wrong += made.grid.full[i] != right.grid.full[i] ? 1 : 0;
  return wrong;
}

TEST(Voxelize, ReportsItsProgress) {
  std::vector<double> shares;
  voxelized(test::box_mesh({1, 1, 1}), {.cells = 4, .watch = [&](double share) { shares.push_back(share); }});
  EXPECT_THAT(shares, ElementsAre(0.0, 0.25, 0.5, 0.75));
}

TEST(Voxelize, ConcavePolygonsAreNoThinWalls) {
  // An L of two hexagons and six quads, whose walls are four cells thick.
  std::string text;
  for (const int z : {0, 1})
    for (const auto& [x, y] : {std::pair(0, 0), {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})
      text += fmt::format("v {} {} {}\n", x, y, z);
  text += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
  for (int i = 0; i < 6; ++i)
    text += fmt::format("f {} {} {} {}\n", i + 1, (i + 1) % 6 + 1, (i + 1) % 6 + 7, i + 7);
  const VoxelizedMesh made = voxelized(parse_obj(text, "l.obj")->mesh, {.cells = 8});
  EXPECT_EQ(made.grid.full_count(), 192u);
  EXPECT_EQ(made.report.thin, 0.0);
}

TEST(Voxelize, CellsOfASphereAreThoseWhoseMiddleIsInside) {
  const VoxelizedMesh made = voxelized(fine_sphere());
  for (int i = 0; i < forty; ++i) {
    for (int j = 0; j < forty; ++j) {
      for (int k = 0; k < forty; ++k) {
        const double r = length(made.grid.center(i, j, k));
        if (r > 0.996 && r < 1.0) continue;  // between the polygons and the ball
        ASSERT_EQ(made.grid.is_full(i, j, k), r < 1.0) << i << " " << j << " " << k;
      }
    }
  }
  EXPECT_NEAR(made.grid.volume(), 4.0 / 3.0 * std::numbers::pi, 0.01 * 4.2);
  EXPECT_NEAR(made.report.mesh_volume, 4.0 / 3.0 * std::numbers::pi, 0.01);
  EXPECT_EQ(made.report.ambiguous, 0.0);
  EXPECT_EQ(made.report.hinges, 0u);
  EXPECT_THAT(made.report.pieces, ElementsAre(made.grid.full_count()));
}

// The columns of the table that the method was chosen by, which parity of rays fails by thousands.
TEST(Voxelize, DamagedSpheresKeepTheirInside) {
  EXPECT_EQ(wrong_cells(test::as_soup(fine_sphere())), 0u);
  EXPECT_EQ(wrong_cells(test::with_turned(fine_sphere(), 0.1, 2)), 0u);
  EXPECT_EQ(wrong_cells(test::with_turned(fine_sphere(), 0.4, 3)), 0u);
  EXPECT_EQ(wrong_cells(test::with_turned(fine_sphere(), 1.0, 4)), 0u);
  EXPECT_EQ(wrong_cells(test::together(fine_sphere(), fine_sphere())), 0u);
  EXPECT_EQ(wrong_cells(test::with_turned(test::together(fine_sphere(), fine_sphere()), 0.5, 5)), 0u);
  // In front of a lost face a cell's middle may be on the wrong side of what closes it: of 8,000 cells at the
  // surface.
  EXPECT_LE(wrong_cells(test::without_share(fine_sphere(), 0.05, 1)), 20u);
  EXPECT_LE(
      wrong_cells(test::without_share(test::with_turned(test::as_soup(fine_sphere()), 0.4, 6), 0.05, 7)),
      20u);
}

// A cap of 4 % of the surface is closed by a lid that is about flat, so that the body loses about the cap.
TEST(Voxelize, AnOpenCapIsClosed) {
  TriangleMesh open = test::without_above(fine_sphere(), 0.92);
  // One corner keeps the box.
  const auto first = static_cast<std::uint32_t>(open.vertices.size());
  for (const Vec3& v : {Vec3{0, 1, 0}, Vec3{1e-3, 1, 0}, Vec3{0, 1, 1e-3}}) open.vertices.push_back(v);
  open.triangles.push_back({first, first + 2, first + 1});
  const double cell = 2.0 / forty, height = 0.08;
  const double cap = std::numbers::pi * height * height * (3.0 - height) / 3.0 / (cell * cell * cell);
  EXPECT_NEAR(static_cast<double>(wrong_cells(open)), cap, 0.5 * cap);
}

TEST(Voxelize, OverlappingPartsAreTheirUnion) {
  const TriangleMesh pair =
      test::together(test::sphere_mesh(4, 1.0, {-0.4, 0, 0}), test::sphere_mesh(4, 1.0, {0.4, 0, 0}));
  const VoxelizedMesh made = voxelized(pair);
  std::size_t wrong = 0;
  for (std::size_t c = 0; c < made.grid.full.size(); ++c) {
    const auto [i, j, k] = made.grid.place(c);
    const Vec3 p = made.grid.center(i, j, k);
    const double r = std::min(length(p - Vec3{-0.4, 0, 0}), length(p - Vec3{0.4, 0, 0}));
    if (r > 0.996 && r < 1.0) continue;
    wrong += made.grid.is_full(i, j, k) != (r < 1.0) ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u);
}

// 20,000 triangles, of which 5 % are missing; bench/mesh_figures has the time.
TEST(Voxelize, TorusWithoutAFewFacesHasItsVolume) {
  constexpr int around = 200, across = 50;
  const TriangleMesh torus = test::torus_mesh(around, across, 1.0, 0.4);
  ASSERT_EQ(torus.triangles.size(), 20'000u);
  const auto read = parse_stl(test::as_stl(test::without_share(torus, 0.05, 8)), "torus.stl");
  ASSERT_TRUE(read.ok());
  const VoxelizedMesh made = voxelized(read->mesh, {.cells = 32});
  const double right = test::torus_volume(around, across, 1.0, 0.4);
  EXPECT_NEAR(enclosed_volume(torus), right, 1e-6 * right);
  EXPECT_NEAR(made.grid.volume(), right, 0.02 * right);
  EXPECT_GT(made.report.repairs.open_edges, 1000u);
}

TEST(Voxelize, BuiltInMeshesAreWhole) {
  for (const std::string& name : builtin_meshes()) {
    const auto read = load_mesh(name);
    ASSERT_TRUE(read.ok()) << read.error().what;
    const VoxelizedMesh made = voxelized(read->mesh, {.cells = 24});
    const MeshRepairs& r = made.report.repairs;
    EXPECT_EQ(r, (MeshRepairs{.faces = r.faces, .vertices = r.vertices, .patches = 1}))
        << "nothing to repair";
    EXPECT_EQ(made.report.pieces.size(), 1u);
    EXPECT_EQ(made.report.hinges, 0u);
    EXPECT_NEAR(made.grid.volume(), made.report.mesh_volume, 0.03 * made.report.mesh_volume);
  }
  EXPECT_THAT(builtin_meshes(), ElementsAre("rabbit"));
}

TEST(Voxelize, GridFollowsTheBox) {
  const VoxelizedMesh made = voxelized(test::box_mesh({1.0, 0.5, 0.26}, {7, 8, 9}), {.cells = 10});
  EXPECT_THAT(made.grid.cells, ElementsAre(10, 5, 3));
  EXPECT_DOUBLE_EQ(made.grid.size, 0.2);
  EXPECT_EQ(made.grid.full_count(), 150u);
  EXPECT_NEAR(length(made.grid.origin - Vec3{-1.0, -0.5, -0.3}), 0.0, 1e-12);
  const Bounds skin = bounds_of(made.skin);
  EXPECT_NEAR(length(skin.low + skin.high), 0.0, 1e-12);
}

TEST(Voxelize, HeightScalesAndUpTurns) {
  // 200 mm high along z, in the numbers of a printer.
  const TriangleMesh mesh = test::box_mesh({30, 50, 100});
  const VoxelizedMesh made = voxelized(mesh, {.cells = 20, .height = 0.2, .up = UpAxis::z});
  EXPECT_NEAR(length(made.report.extent - Vec3{0.06, 0.2, 0.1}), 0.0, 1e-12);
  EXPECT_THAT(made.grid.cells, ElementsAre(6, 20, 10));
  EXPECT_NEAR(made.report.mesh_volume, 0.06 * 0.2 * 0.1, 1e-12) << "still turned outwards";
  EXPECT_FALSE(made.report.odd_size);
  // Without a height its numbers are meters, which is told.
  const VoxelizedMesh large = voxelized(mesh, {.cells = 20});
  EXPECT_TRUE(large.report.odd_size);
  EXPECT_THAT(sentences_of(large), Contains(HasSubstr("give a height in meters")));
}

TEST(Voxelize, PiecesAreKeptOrRefused) {
  const TriangleMesh two = test::together(test::sphere_mesh(3, 1.0), test::sphere_mesh(3, 0.5, {3, 0, 0}));
  const VoxelizedMesh largest = voxelized(two), all = voxelized(two, {.cells = forty, .pieces = Pieces::all});
  ASSERT_EQ(largest.report.pieces.size(), 2u);
  EXPECT_EQ(largest.grid.full_count(), largest.report.pieces[0]);
  EXPECT_EQ(all.grid.full_count(), largest.report.pieces[0] + largest.report.pieces[1]);
  EXPECT_THAT(sentences_of(largest), Contains(HasSubstr("kept the largest of 2 pieces")));
  EXPECT_THAT(sentences_of(all), Contains(HasSubstr("2 pieces, which share no face, move separately")));
  const auto refused = voxelize(two, {.cells = forty, .pieces = Pieces::refuse}, "two.stl");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("two.stl: the cells form 2 pieces"));
}

TEST(Voxelize, ThinWallsAreTold) {
  // A bowl: a shell a twentieth thick.
  const TriangleMesh bowl =
      test::together(test::sphere_mesh(4, 1.0), test::with_turned(test::sphere_mesh(4, 0.95), 1.0, 1));
  const VoxelizedMesh coarse = voxelized(bowl, {.cells = 20}), fine = voxelized(bowl, {.cells = 64});
  EXPECT_EQ(coarse.report.repairs.cavities, 1u);
  EXPECT_GT(coarse.report.thin, 0.9);
  EXPECT_LT(fine.report.thin, 0.05);
  EXPECT_THAT(sentences_of(coarse), Contains(HasSubstr("walls thinner than a cell")));
  EXPECT_THAT(sentences_of(fine), Not(Contains(HasSubstr("walls thinner than a cell"))));
  EXPECT_FALSE(fine.grid.is_full(32, 32, 32)) << "the cavity";
}

TEST(Voxelize, HingesAreTold) {
  const TriangleMesh diagonal = test::together(test::box_mesh({0.5, 0.5, 0.5}, {-0.5, -0.5, 0}),
                                               test::box_mesh({0.5, 0.5, 0.5}, {0.5, 0.5, 0}));
  const VoxelizedMesh hinged = voxelized(diagonal, {.cells = 2, .pieces = Pieces::all});
  EXPECT_EQ(hinged.report.hinges, 1u);
  EXPECT_THAT(sentences_of(hinged), Contains(HasSubstr("hinges")));
}

TEST(Voxelize, HopelessMeshesAreRefusedWithTheirFigures) {
  const auto said = [](const TriangleMesh& mesh, int cells) {
    const auto made = voxelize(mesh, {.cells = cells}, "bad.ply");
    EXPECT_FALSE(made.ok());
    if (made) return std::string();
    EXPECT_EQ(made.error().code, ErrorCode::scene_rejected);
    return made.error().message();
  };
  // Half a sphere without its base, and more than half of all faces missing.
  EXPECT_THAT(said(test::without_above(fine_sphere(), 0.0), forty),
              HasSubstr("inside and outside are ambiguous"));
  const std::string lost = said(test::without_share(fine_sphere(), 0.5, 1), forty);
  EXPECT_THAT(lost, HasSubstr("bad.ply: inside and outside are ambiguous"));
  EXPECT_THAT(lost, HasSubstr("of 64000 cells"));
  EXPECT_THAT(lost, HasSubstr("Close the mesh's holes"));
  // A sheet encloses nothing.
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_THAT(said(sheet, 8), HasSubstr("fills none of 8 × 1 × 8 cells"));
  EXPECT_THAT(said({}, 8), HasSubstr("no face has an area"));
}

}  // namespace
}  // namespace aspic
