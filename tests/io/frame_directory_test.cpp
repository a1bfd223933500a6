#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/video_format.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::HasSubstr;
constexpr ImageSize size = {5, 3};

std::vector<std::byte> gray(int level) {
  return std::vector<std::byte>(std::size_t{3} * 5 * 3, static_cast<std::byte>(level));
}

/// Width and height from the header of a PNG file (ISO/IEC 15948, 11.2.2).
std::array<int, 2> png_size(const std::string& file) {
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(file.at(at + i));
    return value;
  };
  return {number(16), number(20)};
}

TEST(FrameDirectory, NumbersItsImages) {
  const test::TemporaryDirectory dir;
  auto sink = open_frame_directory(dir.file("out"), *find_video_format("png"), size, Overwrite::refuse);
  ASSERT_TRUE(sink.ok()) << sink.error().message();
  ASSERT_TRUE((*sink)->write(gray(10)).ok());
  ASSERT_TRUE((*sink)->write(gray(20)).ok());
  ASSERT_TRUE((*sink)->finish().ok());
  const std::string first = dir.read("out/frame-000000.png");
  EXPECT_EQ(png_size(first), (std::array{5, 3}));
  EXPECT_NE(first, dir.read("out/frame-000001.png"));
}

TEST(FrameDirectory, WritesJpeg) {
  const auto content = encode_jpeg(size, gray(99));
  ASSERT_TRUE(content.ok());
  EXPECT_TRUE(content->starts_with("\xff\xd8\xff"));
}

TEST(FrameDirectory, RefusesImagesOfAnEarlierRun) {
  const test::TemporaryDirectory dir;
  dir.write("frame-000007.jpg", "old");
  dir.write("notes.txt", "mine");
  const auto refused =
      open_frame_directory(dir.path().string(), *find_video_format("png"), size, Overwrite::refuse);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(), HasSubstr("frame-000007.jpg"));
  EXPECT_THAT(refused.error().message(), HasSubstr("or pass Overwrite::allow."));
  EXPECT_EQ(dir.read("frame-000007.jpg"), "old");

  dir.write("frame-000000.png", "old");
  dir.write("frame-000001.png", "old");
  const auto allowed =
      open_frame_directory(dir.path().string(), *find_video_format("png"), size, Overwrite::allow);
  ASSERT_TRUE(allowed.ok());
  EXPECT_EQ(dir.entries(), 4u) << "a video that does not begin costs nothing";
  ASSERT_TRUE((*allowed)->write(gray(10)).ok());
  EXPECT_EQ(dir.entries(), 2u) << "old images go, other files stay";
  EXPECT_EQ(png_size(dir.read("frame-000000.png")), (std::array{5, 3}));
  EXPECT_EQ(dir.read("notes.txt"), "mine");
  ASSERT_TRUE((*allowed)->write(gray(20)).ok());
  dir.write("frame-000002.png", "another's");
  EXPECT_FALSE((*allowed)->write(gray(30)).ok()) << "what came in the meantime is not replaced";
}

TEST(FrameDirectory, RefusesWhatIsNoDirectory) {
  const test::TemporaryDirectory dir;
  dir.write("file", "x");
  const auto file = open_frame_directory(dir.file("file"), *find_video_format("png"), size, Overwrite::allow);
  ASSERT_FALSE(file.ok());
  EXPECT_THAT(file.error().message(), HasSubstr("is a file"));
  EXPECT_FALSE(
      open_frame_directory(dir.file("no/such"), *find_video_format("png"), size, Overwrite::allow).ok());
}

}  // namespace
}  // namespace aspic
