#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/read_mesh.h"
#include "mesh/shapes.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string stl_error(const std::string& bytes) {
  const auto read = parse_stl(bytes, "a.stl");
  EXPECT_FALSE(read.ok());
  if (read) return {};
  EXPECT_EQ(read.error().code, ErrorCode::scene_rejected);
  return read.error().what;
}

constexpr std::string_view facet =
    "facet normal 0 0 1\n  outer loop\n    vertex 0 0 0\n    vertex 1 0 0\n    vertex 1 1 0\n  "
    "endloop\nendfacet\n";

TEST(ReadStl, BinaryIsReadByItsSize) {
  const TriangleMesh sphere = test::sphere_mesh(1, 2.0);
  std::string bytes = test::as_stl(sphere);
  bytes.replace(0, 5, "solid");  // as some programs begin binary files too
  const auto read = parse_stl(bytes, "a.stl");
  ASSERT_TRUE(read.ok()) << read.error().what;
  ASSERT_EQ(read->mesh.triangles.size(), sphere.triangles.size());
  for (std::size_t f = 0; f < sphere.triangles.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT(
          length(read->mesh.vertices[read->mesh.triangles[f][i]] - sphere.vertices[sphere.triangles[f][i]]),
          1e-6);
  EXPECT_THAT(read->notes, IsEmpty());
  const auto longer = parse_stl(test::as_stl(sphere) + "123", "a.stl");
  ASSERT_TRUE(longer.ok());
  EXPECT_THAT(longer->notes, ElementsAre("byte 4084: ignored 3 bytes after the last triangle"));
}

TEST(ReadStl, AsciiIsReadWhateverItsCapitalsAndSolids) {
  const std::string text = "solid one part\n" + std::string(facet) +
                           "endsolid one part\nSOLID\nFACET NORMAL nan nan nan\r\nOUTER LOOP\r\nVERTEX 1e0 "
                           "0 0\nVertex 0 1 0\nVERTEX 0 0 1\nENDLOOP ENDFACET\nENDSOLID\n";
  const auto read = parse_stl(text, "a.stl");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 4, 5}));
  EXPECT_EQ(read->mesh.vertices[5], (Vec3{0, 0, 1}));
}

TEST(ReadStl, TakesAByteOrderMarkAndEveryKindOfLineEnd) {
  const std::string text = "solid W\xc3\xbcrfel\n" + std::string(facet) + "endsolid\n";
  std::string mac = text;
  std::ranges::replace(mac, '\n', '\r');
  for (const std::string& bytes : {"\xef\xbb\xbf" + text, mac}) {
    const auto read = parse_stl(bytes, "a.stl");
    ASSERT_TRUE(read.ok()) << read.error().what;
    EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  }
  EXPECT_THAT(stl_error(mac + "hello"), HasSubstr("a.stl:10: 'hello' is not a word of STL"));
}

TEST(ReadStl, CountsTrianglesWhereTheHeaderNamesNone) {
  std::string bytes = test::as_stl(test::box_mesh({1, 1, 1}));
  bytes.replace(80, 4, 4, '\0');
  const auto read = parse_stl(bytes, "a.stl");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_EQ(read->mesh.triangles.size(), 12u);
  EXPECT_THAT(read->notes, ElementsAre("byte 80: the header declares 0 triangles, and the file has 12"));
}

TEST(ReadMesh, SaysThatAFileIsUtf16) {
  for (const char* name : {"a.obj", "a.stl", "a.ply"})
    for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
      const auto read = parse_mesh(mark + std::string("v\0 \0"
                                                      "0\0",
                                                      6),
                                   name);
      ASSERT_FALSE(read.ok());
      EXPECT_THAT(read.error().what, HasSubstr("this is UTF-16; save it as UTF-8"));
    }
}

TEST(ReadStl, ErrorsNameThePlaceAndWhatHelps) {
  const std::string whole = test::as_stl(test::box_mesh({1, 1, 1}));
  EXPECT_THAT(stl_error(whole.substr(0, 300)),
              HasSubstr("a.stl: byte 80: the header declares 12 triangles (684 bytes), and the file has "
                        "300 bytes. The file is truncated"));
  EXPECT_THAT(stl_error(whole.substr(0, 40)),
              HasSubstr("a.stl: byte 40: the file ends in its header of 84 bytes"));
  EXPECT_THAT(stl_error(""), HasSubstr("a.stl: byte 0"));
  std::string empty = whole.substr(0, 84);
  empty.replace(80, 4, 4, '\0');
  EXPECT_THAT(stl_error(empty), HasSubstr("no vertex and no face"));
  const std::string text(facet);
  EXPECT_THAT(stl_error("solid\n" + text.substr(0, text.find("0 0\n    vertex 1 1"))),
              HasSubstr("a.stl:5: the file ends inside a vertex"));
  EXPECT_THAT(stl_error("solid\n" + text.substr(0, text.find("    vertex 1 1"))),
              HasSubstr("the file ends inside a facet"));
  EXPECT_THAT(stl_error("solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
              HasSubstr("a.stl:6: this facet has 2 corners"));
  EXPECT_THAT(stl_error("solid\nfacet\nouter loop\nvertex 0 up 0\n"),
              HasSubstr("a.stl:4: 'up' is not a number"));
  EXPECT_THAT(stl_error("solid\ntriangle 1 2 3\n"), HasSubstr("a.stl:2: 'triangle' is not a word of STL"));
  EXPECT_THAT(stl_error("solid\nendsolid\n"), HasSubstr("no vertex and no face"));
}

}  // namespace
}  // namespace aspic
