#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "mesh/read_mesh.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string ply_error(const std::string& bytes) {
  const auto read = parse_ply(bytes, "a.ply");
  EXPECT_FALSE(read.ok()) << bytes;
  if (read) return {};
  EXPECT_EQ(read.error().code, ErrorCode::scene_rejected);
  return read.error().what;
}

/// Four corners, a triangle and a square, an element that nobody knows, and properties that mean nothing
/// here.
std::string header(std::string_view format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by hand\nobj_info none\nelement vertex 4\nproperty float x\nproperty "
      "uchar red\nproperty "
      "double y\nproperty float32 z\nelement camera 2\nproperty list uchar short lens\nproperty int "
      "focus\nelement face 2\nproperty "
      "uchar flags\nproperty list uchar int vertex_indices\nproperty list uint8 float texcoord\nelement "
      "nothing 1000000000000\nend_header\n",
      format);
}
const std::string ascii_body =
    "0 255 0 0\n1 0 0 0\n1 0 1 0\n0 0 1 0.5\n2 -7 8 3\n0 1\n0 3 0 1 2 1 0.5\n1 4 0 1 2 3 0\n";

/// The same values as bytes.
std::string binary_body(bool big_endian) {
  std::string bytes;
  const auto add = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big_endian) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
  };
  const auto byte = [&](int value) { add(static_cast<std::uint8_t>(value)); };
  const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  for (const auto& p : places) {
    add(static_cast<float>(p[0]));
    byte(255);
    add(p[1]);
    add(static_cast<float>(p[2]));
  }
  byte(2);
  add(std::int16_t{-7});
  add(std::int16_t{8});
  add(std::int32_t{3});
  byte(0);
  add(std::int32_t{1});
  byte(0);
  byte(3);
  for (const int v : {0, 1, 2}) add(v);
  byte(1);
  add(0.5f);
  byte(1);
  byte(4);
  for (const int v : {0, 1, 2, 3}) add(v);
  byte(0);
  return bytes;
}

TEST(ReadPly, FormatsAgree) {
  for (const std::string& file :
       {header("ascii") + ascii_body, header("binary_little_endian") + binary_body(false),
        header("binary_big_endian") + binary_body(true)}) {
    const auto read = parse_ply(file, "a.ply");
    ASSERT_TRUE(read.ok()) << read.error().what;
    EXPECT_THAT(read->mesh.vertices,
                ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0.5}));
    EXPECT_THAT(read->mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  }
}

TEST(ReadPly, TakesHeadersWithEveryKindOfLineEnd) {
  const std::string text = header("binary_little_endian");
  for (const std::string_view end : {"\r", "\r\n"}) {
    std::string other;
    for (const char c : text) c == '\n' ? void(other += end) : other.push_back(c);
    const auto read = parse_ply(other + binary_body(false), "a.ply");
    ASSERT_TRUE(read.ok()) << read.error().what;
    EXPECT_EQ(read->mesh.triangles.size(), 3u);
  }
  // The first byte of the body is that of a line feed.
  const std::string short_header =
      "ply\rformat binary_little_endian 1.0\relement x 1\rproperty uchar x\relement vertex 3\rproperty uchar "
      "x\rproperty uchar y\rproperty uchar z\relement face 1\rproperty list uchar uchar vertex_index\r"
      "end_header\r";
  const auto read = parse_ply(short_header + std::string("\n\0\0\0\1\0\0\1\1\0\3\0\1\2", 14), "a.ply");
  ASSERT_TRUE(read.ok()) << read.error().what;
  EXPECT_EQ(read->mesh.vertices[2], (Vec3{1, 1, 0}));
}

TEST(ReadPly, HeaderErrorsNameTheLine) {
  EXPECT_THAT(ply_error(""), HasSubstr("a.ply:1: the first line is not 'ply'"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\n"),
              HasSubstr("a.ply:3: the header has no end"));
  EXPECT_THAT(ply_error("ply\nend_header\n"), HasSubstr("a.ply:2: the header names no format"));
  EXPECT_THAT(ply_error("ply\nformat utf8 1.0\n"), HasSubstr("a.ply:2: 'utf8' is not a format of PLY"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex -1\n"),
              HasSubstr("a.ply:3: '-1' is not a number of elements"));
  EXPECT_THAT(ply_error("ply\nproperty float x\n"), HasSubstr("a.ply:2: a property comes after"));
  EXPECT_THAT(ply_error("ply\nelement vertex 1\nproperty half x\n"),
              HasSubstr("a.ply:3: 'half' is not a type of PLY"));
  EXPECT_THAT(ply_error("ply\nelement face 1\nproperty list float int vertex_indices\n"),
              HasSubstr("a.ply:3: 'float' is not a type of a list's length"));
  EXPECT_THAT(ply_error("ply\nelement vertex 1\nproperty float\n"),
              HasSubstr("a.ply:3: this property has no name"));
  EXPECT_THAT(ply_error("ply\nwobble\n"), HasSubstr("a.ply:2: 'wobble' is not a word of a PLY header"));
  EXPECT_THAT(
      ply_error(
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"),
      HasSubstr("x, y and z"));
}

TEST(ReadPly, BodyErrorsNameThePlace) {
  const std::string text = header("ascii");
  EXPECT_THAT(ply_error(text + "0 255 0 0\n1 0 zero 0\n"), HasSubstr("a.ply:20: 'zero' is not a number"));
  EXPECT_THAT(ply_error(text + "0 255 0 0\n1 0.5 0 0\n"), HasSubstr("a.ply:20: '0.5' is not an integer"));
  EXPECT_THAT(ply_error(text + "0 255 0 0\n1 0 0 0\n"), HasSubstr("the file ends before its last element"));
  std::string wrong = text + ascii_body;
  wrong.replace(wrong.find("4 0 1 2 3"), 9, "4 0 1 2 9");
  EXPECT_THAT(ply_error(wrong), HasSubstr("a.ply:26: this face names vertex 9"));
  wrong.replace(wrong.find("4 0 1 2 9"), 9, "4 0 1 -2 9");
  EXPECT_THAT(ply_error(wrong), HasSubstr("a.ply:26: -2 names no vertex"));

  const std::string binary = header("binary_little_endian");
  const std::size_t at = binary.size();
  EXPECT_THAT(ply_error(binary + binary_body(false).substr(0, 30)),
              HasSubstr(fmt::format("a.ply: byte {}: the file ends before", at + 30)));
  std::string lens = binary + binary_body(false);
  lens[at + 4 * 17] = '\xff';  // a list of 255 numbers, where 38 bytes are left
  EXPECT_THAT(ply_error(lens),
              HasSubstr(fmt::format("a.ply: byte {}: a list of 255 numbers does not fit", at + 68)));
}

// Numbers in headers that no file holds are not believed, and cost neither time nor memory.
TEST(ReadPly, PromisesAreBelievedAsFarAsTheBytesGo) {
  EXPECT_THAT(ply_error("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000000000\nproperty "
                        "float x\nproperty float "
                        "y\nproperty float z\nend_header\n0000"),
              HasSubstr("the file ends before its last element"));
  EXPECT_THAT(
      ply_error(
          "ply\nformat ascii 1.0\nelement face 9\nproperty list int int vertex_indices\nend_header\n-1\n"),
      HasSubstr("a list of -1 numbers does not fit"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 9223372036854775807\nend_header\n"),
              HasSubstr("no vertex"));
  std::string many = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 65; ++i) many += "element e 1\n";
  EXPECT_THAT(ply_error(many + "end_header\n"), HasSubstr("a.ply:67: there are more than 64 elements"));
}

TEST(ReadPly, StripsAndPointsAreRefused) {
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_THAT(ply_error(points + "end_header\n0 0 0\n"),
              HasSubstr("1 vertices and no face: points alone have no inside"));
  EXPECT_THAT(
      ply_error(points +
                "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n3 0 0 0\n"),
      HasSubstr("the triangles are strips"));
}

}  // namespace
}  // namespace aspic
