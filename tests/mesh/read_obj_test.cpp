#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/read_mesh.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string obj_error(const std::string& text) {
  const auto read = parse_obj(text, "a.obj");
  EXPECT_FALSE(read.ok()) << text;
  if (read) return {};
  EXPECT_EQ(read.error().code, ErrorCode::scene_rejected);
  return read.error().what;
}

TEST(ReadObj, TakesVerticesAndFacesAndPassesOverTheRest) {
  const auto read = parse_obj(
      "# a comment\r\nmtllib a.mtl\no thing\nv 0 0 0 1.0\r\nv 1e0 +0 .0 0.5 0.5 0.5\nv 1 -1 0 # end\nvn 0 0 "
      "1\nvt 0 0\ng "
      "left\nusemtl red\ns off\nf 1/1/1 2//1 3\nl 1 2\n",
      "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->mesh.vertices, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, -1, 0}));
  EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(read->notes, IsEmpty());
}

TEST(ReadObj, PolygonsAreFans) {
  const auto read = parse_obj(std::string(corners) + "f 1 2 3 4", "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

/// Twice the area of all triangles, which is twice that of the polygon where none is outside of it.
double twice_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
    sum += length(area_vector(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  return sum;
}

TEST(ReadObj, CutsConcavePolygonsWithinTheirOutline) {
  constexpr std::string_view l = "v 0 0 2\nv 2 0 2\nv 2 1 2\nv 1 1 2\nv 1 2 2\nv 0 2 2\n";
  // A cross of twelve corners, in a plane that no axis is normal to.
  std::string cross;
  for (const auto& [u, v] : {std::pair(1, 0),
                             {2, 0},
                             {2, 1},
                             {3, 1},
                             {3, 2},
                             {2, 2},
                             {2, 3},
                             {1, 3},
                             {1, 2},
                             {0, 2},
                             {0, 1},
                             {1, 1}})
    cross += fmt::format("v {} {} {}\n", u, v, u + v);
  for (int first = 0; first < 12; ++first) {
    for (const bool backwards : {false, true}) {
      const auto face = [&](int corners) {
        std::string text = "f";
        for (int n = 0; n < corners; ++n)
          text += fmt::format(" {}", 1 + (first + (backwards ? corners - n : n)) % corners);
        return text;
      };
      const auto read = parse_obj(std::string(l) + face(6), "l.obj");
      ASSERT_TRUE(read.ok());
      EXPECT_EQ(read->mesh.triangles.size(), 4u);
      EXPECT_NEAR(twice_area(read->mesh), 6.0, 1e-12) << face(6);
      const auto other = parse_obj(cross + face(12), "cross.obj");
      ASSERT_TRUE(other.ok());
      EXPECT_EQ(other->mesh.triangles.size(), 10u);
      EXPECT_NEAR(twice_area(other->mesh), 10.0 * std::sqrt(3.0), 1e-12) << face(12);
    }
  }
}

TEST(ReadObj, CutsPolygonsThatNameACornerTwice) {
  // The first corner once more at the end, and a square hole joined to the outline by a bridge.
  const auto closed =
      parse_obj("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6 1\n", "c.obj");
  ASSERT_TRUE(closed.ok());
  EXPECT_NEAR(twice_area(closed->mesh), 6.0, 1e-12);
  const auto hole = parse_obj(
      "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\nf 1 2 3 4 1 5 6 7 8 5\n",
      "hole.obj");
  ASSERT_TRUE(hole.ok());
  EXPECT_NEAR(twice_area(hole->mesh), 16.0, 1e-12);
}

TEST(ReadObj, HalvesConvexPolygonsOfManyCorners) {
  constexpr int n = 1000;
  std::string circle, face = "f";
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    circle += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  const auto read = parse_obj(circle + face, "circle.obj");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->mesh.triangles.size(), n - 2u);
  EXPECT_NEAR(twice_area(read->mesh), n * std::sin(2.0 * std::numbers::pi / n), 1e-12);
  std::size_t at_first = 0;
  for (const Triangle& t : read->mesh.triangles) at_first += std::ranges::count(t, 0u) > 0 ? 1 : 0;
  EXPECT_LT(at_first, 20u);
}

TEST(ReadObj, TellsOfConcavePolygonsOfTooManyCorners) {
  std::string star, face = "f";
  for (int n = 0; n < 3000; ++n) {
    const double r = n % 2 ? 1.0 : 2.0, angle = 2.0 * std::numbers::pi * n / 3000;
    star += fmt::format("v {} {} 0\n", r * std::cos(angle), r * std::sin(angle));
    face += fmt::format(" {}", n + 1);
  }
  const auto read = parse_obj(star + face, "star.obj");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->mesh.triangles.size(), 2998u);
  EXPECT_THAT(read->notes, ElementsAre(HasSubstr("concave faces of more than 2000 corners")));
}

TEST(ReadObj, TakesEveryKindOfLineEnd) {
  const std::string text = std::string(corners) + "f 1 2 \\\n 3\n";
  for (const std::string_view end : {"\r", "\r\n"}) {
    std::string other;
    for (const char c : text) c == '\n' ? void(other += end) : other.push_back(c);
    const auto read = parse_obj(other, "a.obj");
    ASSERT_TRUE(read.ok()) << read.error().what;
    EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
    EXPECT_THAT(obj_error(other + "v x"), HasSubstr("a.obj:7: 'x' is not a number"));
  }
}

TEST(ReadObj, NegativeIndicesCountBackFromTheLine) {
  const auto read = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n", "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(ReadObj, LinesContinueAfterABackslashAndFacesMayComeFirst) {
  const auto read = parse_obj("f 1 \\\n 2 \\\n 3\n" + std::string(corners), "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(obj_error("v 0 0 \\\n 0\nv x 0 0\n"), HasSubstr("a.obj:3: 'x' is not a number"));
}

TEST(ReadObj, NumbersThatAreNotFiniteAreReadForRepairToLeaveOut) {
  const auto read = parse_obj("v nan 1.#QNAN -inf\nv 1e999 -1e-999 0.000\nv 1 1 1\nf 1 2 3\n", "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_TRUE(std::isnan(read->mesh.vertices[0].x) && std::isnan(read->mesh.vertices[0].y));
  EXPECT_TRUE(std::isinf(read->mesh.vertices[0].z) && std::isinf(read->mesh.vertices[1].x));
  EXPECT_EQ(read->mesh.vertices[1].y, 0.0);
}

TEST(ReadObj, ErrorsNameTheLineAndWhatHelps) {
  EXPECT_THAT(obj_error("v 0 0\n"),
              HasSubstr("a.obj:1: this vertex has less than three numbers; a vertex is v 0.1 0.2 0.3"));
  EXPECT_THAT(obj_error("\nv 0,5 0 0\n"),
              HasSubstr("a.obj:2: '0,5' is not a number; export with decimal points"));
  EXPECT_THAT(obj_error(std::string(corners) + "f 1 2 0\n"), HasSubstr("a.obj:5: '0' names no vertex"));
  EXPECT_THAT(obj_error(std::string(corners) + "f 1 2 -5\n"),
              HasSubstr("a.obj:5: '-5' names a vertex before the first: there are 4"));
  EXPECT_THAT(obj_error(std::string(corners) + "f 1 2 3\nf 1 2 9\nf 1 2 4"),
              HasSubstr("a.obj:6: this face names vertex 8, counted from 0, and the file has 4"));
  EXPECT_THAT(obj_error(std::string(corners) + "f 1 2 99999999999\n"), HasSubstr("too large"));
  EXPECT_THAT(obj_error(std::string(corners) + "surf 0 1 0 1 1 2 3\n"),
              HasSubstr("a.obj:5: 'surf' describes a free-form surface"));
  EXPECT_THAT(obj_error(std::string(corners)), HasSubstr("4 vertices and no face"));
  EXPECT_THAT(obj_error(""), HasSubstr("a.obj:1: there is no vertex and no face"));
  EXPECT_THAT(obj_error(std::string("v 0 0 0\n\0", 9)), HasSubstr("a.obj: byte 8: this is a binary file"));
}

TEST(ReadObj, NotesWhatItDoesNotKnow) {
  const auto read = parse_obj(std::string(corners) + "wobble 3\nf 1 2\nf 1 2 3\nwobble\n", "a.obj");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->notes, ElementsAre("line 5: ignored the unknown 'wobble'",
                                       "faces of less than three corners were left out: 1"));
}

TEST(ReadMesh, EndingOrBeginningChoosesTheFormat) {
  EXPECT_TRUE(parse_mesh(std::string(corners) + "f 1 2 3", "A.OBJ").ok());
  const auto unknown = parse_mesh("glTF", "bunny.glb");
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().what,
              HasSubstr("bunny.glb: unsupported mesh format (supported: .obj, .stl, .ply"));
  const auto ply = parse_mesh("ply\nformat ascii 1.0\nend_header\n", "bunny");
  ASSERT_FALSE(ply.ok());
  EXPECT_THAT(ply.error().what, HasSubstr("no vertex and no face"));
  EXPECT_EQ(load_mesh("/nowhere/bunny.obj").error().code, ErrorCode::io);
}

}  // namespace
}  // namespace aspic
