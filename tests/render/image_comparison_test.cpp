// What golden pictures let pass, and what they do not.
#include "render/image_comparison.h"

#include <gtest/gtest.h>

namespace aspic::test {
namespace {

constexpr int width = 200, height = 100;  // four pixels may lie on the other side of an edge

/// Dark on the left of a slanting edge, bright on the right of it.
Image edge() {
  Image image{width, height, std::vector<std::byte>(3 * width * height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.rgb[static_cast<std::size_t>(3 * (y * width + x) + c)] = std::byte(x < 50 + y / 2 ? 40 : 200);
  return image;
}

void set(Image& image, int x, int y, int value) {
  for (int c = 0; c < 3; ++c)
    image.rgb[static_cast<std::size_t>(3 * (y * width + x) + c)] = static_cast<std::byte>(value);
}

TEST(ImageComparison, LetsRoundingPass) {
  Image image = edge();
  for (std::byte& b : image.rgb) b = static_cast<std::byte>(std::to_integer<int>(b) + 2);
  EXPECT_FALSE(difference_from(edge(), image));
}

TEST(ImageComparison, LetsAFewPixelsChangeSidesOfAnEdge) {
  Image image = edge();
  for (const int y : {10, 30, 50, 70}) set(image, 50 + y / 2, y, 100);
  EXPECT_FALSE(difference_from(edge(), image));
  set(image, 50 + 90 / 2, 90, 100);
  EXPECT_TRUE(difference_from(edge(), image)) << "a fifth one";
}

TEST(ImageComparison, FindsASpeckAndAShade) {
  Image speck = edge();
  set(speck, 20, 20, 60);
  EXPECT_TRUE(difference_from(edge(), speck)) << "nothing there is so bright";
  Image shade = edge();
  for (std::byte& b : shade.rgb) b = static_cast<std::byte>(std::to_integer<int>(b) + 3);
  EXPECT_TRUE(difference_from(edge(), shade));
}

TEST(ImageComparison, FindsAnEdgeThatMovedByAPixel) {
  Image moved = edge();
  for (int y = 0; y < height; ++y) set(moved, 50 + y / 2, y, 40);
  EXPECT_TRUE(difference_from(edge(), moved));
}

}  // namespace
}  // namespace aspic::test
