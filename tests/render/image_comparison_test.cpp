// What golden images let pass, and what they do not.
#include "support/image_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

namespace aspic::test {
namespace {

constexpr int width = 160, height = 96;
constexpr int dark = 60, bright = 180;

/// An image of gray values.
Image image_of(const std::function<double(int x, int y)>& gray) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.rgb.insert(image.rgb.end(), 3, static_cast<std::byte>(std::lround(gray(x, y))));
  return image;
}

/// How much of a pixel lies to the right of a slanting edge, told from four samples as a rasterizer takes
/// them.
double coverage(int x, int y, double moved) {
  constexpr double samples[4][2] = {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}};
  double covered = 0.0;
  for (const auto& [across, down] : samples)
    covered += x + across >= 40.0 + moved + 0.4 * (y + down) ? 0.25 : 0.0;
  return covered;
}

/// Dark on the left of an edge, bright on the right of it, and sky above both.
Image edge(double moved = 0.0, double contrast = bright - dark) {
  return image_of([&](int x, int y) { return dark + contrast * coverage(x, y, moved) + 0.2 * y; });
}

void set(Image& image, int x, int y, int value) {
  for (int c = 0; c < 3; ++c)
    image.rgb[static_cast<std::size_t>(3 * (y * width + x) + c)] = static_cast<std::byte>(value);
}

int gray(const Image& image, int x, int y) {
  return image.channel(x, y, 0);
}

bool agree(const Image& golden, const Image& image) {
  return !difference_from(golden_form(golden), image);
}

TEST(ImageComparison, GoldenFormIsHalfTheSizeAndEven) {
  const Image golden = golden_form(image_of([](int x, int y) { return x % 2 + 2 * (y % 2) + 100 + y / 48; }));
  EXPECT_EQ(golden.width, width / 2);
  EXPECT_EQ(golden.height, height / 2);
  EXPECT_EQ(golden.rgb.size(), 3u * (width / 2) * (height / 2));
  EXPECT_EQ(golden.channel(3, 3, 1), 102) << "of 101.5";
  EXPECT_EQ(golden.channel(3, 40, 1), 102) << "of 102.5";
  EXPECT_EQ(golden_form(image_of([](int, int) { return 255; })).channel(0, 0, 0), 254);
}

TEST(ImageComparison, LetsRoundingPass) {
  for (const int off : {-1, 1}) {
    Image image = edge();
    for (std::byte& b : image.rgb) b = static_cast<std::byte>(std::to_integer<int>(b) + off);
    EXPECT_TRUE(agree(edge(), image)) << off;
  }
}

TEST(ImageComparison, LetsAnEdgeFallOnTheOtherSideOfASample) {
  for (const double moved : {-0.25, -0.1, 0.1, 0.25}) EXPECT_TRUE(agree(edge(), edge(moved))) << moved;
  // Here and there, at random.
  const Image right = edge(0.25), left = edge(-0.25);
  const Image mixed = image_of([&](int x, int y) { return gray(y * 7 % 5 < 2 ? right : left, x, y); });
  EXPECT_TRUE(agree(edge(), mixed));
}

TEST(ImageComparison, FindsAnEdgeThatMovedByAPixel) {
  for (const double moved : {-2.0, -1.0, 1.0, 2.0}) {
    EXPECT_FALSE(agree(edge(), edge(moved))) << moved;
    EXPECT_FALSE(agree(edge(0.0, 60.0), edge(moved, 60.0))) << "faint, moved by " << moved;
  }
  EXPECT_FALSE(agree(edge(0.0, 24.0), edge(2.0, 24.0))) << "fainter";
}

TEST(ImageComparison, FindsAShade) {
  for (const int off : {-4, 4}) {
    Image image = edge();
    for (std::byte& b : image.rgb) b = static_cast<std::byte>(std::to_integer<int>(b) + off);
    EXPECT_FALSE(agree(edge(), image)) << off;
  }
  Image patch = edge();
  for (int y = 20; y < 36; ++y)
    for (int x = 100; x < 116; ++x) set(patch, x, y, gray(patch, x, y) + 4);
  EXPECT_FALSE(agree(edge(), patch)) << "in one place";
}

TEST(ImageComparison, FindsAChannelOff) {
  Image image = edge();
  for (std::size_t i = 2; i < image.rgb.size(); i += 3)
    image.rgb[i] = static_cast<std::byte>(std::to_integer<int>(image.rgb[i]) + 4);
  EXPECT_FALSE(agree(edge(), image));
}

TEST(ImageComparison, FindsASpeckThatComesOrGoes) {
  Image speck = edge();
  for (const auto& [x, y] : {std::pair(120, 50), std::pair(121, 50), std::pair(121, 51)})
    set(speck, x, y, gray(speck, x, y) - 30);
  EXPECT_FALSE(agree(edge(), speck)) << "comes";
  EXPECT_FALSE(agree(speck, edge())) << "goes";
  Image single = edge();
  set(single, 20, 20, bright);
  EXPECT_FALSE(agree(edge(), single)) << "one pixel comes";
  EXPECT_FALSE(agree(single, edge())) << "one pixel goes";
}

TEST(ImageComparison, FindsASpeckOnAnEdge) {
  Image speck = edge();
  for (int y = 50; y < 52; ++y)
    for (int x = 56; x < 58; ++x) set(speck, x, y, 255);
  EXPECT_FALSE(agree(edge(), speck));
}

TEST(ImageComparison, FindsALineThatIsNotDrawn) {
  const auto lines = [](bool all) {
    return image_of([&](int x, int y) { return x % 16 == 3 && (all || x != 83) ? 90.0 : 110.0 + 0.2 * y; });
  };
  EXPECT_TRUE(agree(lines(true), lines(true)));
  EXPECT_FALSE(agree(lines(true), lines(false)));
  EXPECT_FALSE(agree(lines(false), lines(true)));
}

/// A golden image at the size of a drawn one, with everything so many drawn pixels further.
Image enlarged(const Image& golden, int right, int down) {
  Image image{2 * golden.width, 2 * golden.height, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        image.rgb.push_back(
            static_cast<std::byte>(golden.channel(std::clamp((x - right) / 2, 0, golden.width - 1),
                                                  std::clamp((y - down) / 2, 0, golden.height - 1), c)));
  return image;
}

TEST(ImageComparison, FindsAPixelsMotionInEveryGoldenImage) {
  int images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(ASPIC_GOLDEN)) {
    if (entry.path().extension() != ".png") continue;
    ++images;
    const Image golden = read_image(entry.path().string());
    EXPECT_FALSE(difference_from(golden, enlarged(golden, 0, 0))) << entry.path();
    // Pages have no text on their images; without its edges half a pixel of a net is within the bounds.
    const int far = entry.path().stem().string().starts_with("page-") ? 2 : 1;
    for (const auto& [right, down] :
         {std::pair(far, 0), std::pair(-far, 0), std::pair(0, far), std::pair(0, -far)})
      EXPECT_TRUE(difference_from(golden, enlarged(golden, right, down)))
          << entry.path() << " by " << right << ", " << down;
  }
  EXPECT_GE(images, 20);
}

}  // namespace
}  // namespace aspic::test
