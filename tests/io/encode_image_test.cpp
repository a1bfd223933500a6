// Images as files hold what was drawn: read back by another library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "base/split_mix.h"
#include "io/video_format.h"

// After the others: it is plain C.
#include <stb_image.h>

namespace aspic {
namespace {

constexpr ImageSize encoded_size = {67, 41};  // no multiple of a JPEG's blocks

struct Read {
  ImageSize size;
  int channels = 0;  // as the file has them
  std::vector<std::byte> pixels;
};

Read read(const std::string& file, int channels) {
  Read result;
  const std::unique_ptr<stbi_uc, void (*)(void*)> bytes(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()), static_cast<int>(file.size()),
                            &result.size.width, &result.size.height, &result.channels, channels),
      stbi_image_free);
  if (!bytes) return result;
  const auto* const begin = reinterpret_cast<const std::byte*>(bytes.get());
  result.pixels.assign(begin, begin + result.size.width * result.size.height * channels);
  return result;
}

/// Every byte by chance.
std::vector<std::byte> noise(int channels) {
  SplitMix64 random(1);
  std::vector<std::byte> pixels(
      static_cast<std::size_t>(channels * encoded_size.width * encoded_size.height));
  std::ranges::generate(pixels, [&] { return static_cast<std::byte>(random() >> 56); });
  return pixels;
}

/// A slope of each color, with an edge across.
std::vector<std::byte> slopes() {
  std::vector<std::byte> pixels;
  for (int y = 0; y < encoded_size.height; ++y) {
    for (int x = 0; x < encoded_size.width; ++x) {
      const int values[] = {3 * x, 5 * y, x > y ? 200 : 40};
      for (const int value : values) pixels.push_back(static_cast<std::byte>(value));
    }
  }
  return pixels;
}

TEST(EncodeImage, PngHoldsEveryByte) {
  for (const auto& pixels : {noise(3), slopes(), std::vector<std::byte>(3 * 67 * 41, std::byte{255})}) {
    const auto file = encode_png(encoded_size, pixels);
    ASSERT_TRUE(file.ok()) << file.error().message();
    const Read back = read(*file, 3);
    EXPECT_EQ(back.size, encoded_size);
    EXPECT_EQ(back.channels, 3);
    EXPECT_EQ(back.pixels, pixels);
  }
}

TEST(EncodeImage, ClearPngHoldsEveryByte) {
  const auto pixels = noise(4);
  const auto file = encode_clear_png(encoded_size, pixels);
  ASSERT_TRUE(file.ok()) << file.error().message();
  const Read back = read(*file, 4);
  EXPECT_EQ(back.size, encoded_size);
  EXPECT_EQ(back.channels, 4);
  EXPECT_EQ(back.pixels, pixels);
}

// JPEG tables of quality 93 have steps of 2 to 17 (the scale 14 % of ITU T.81, K.1): what an edge loses is
// less than the largest of them.
TEST(EncodeImage, JpegIsNear) {
  const auto pixels = slopes();
  const auto file = encode_jpeg(encoded_size, pixels);
  ASSERT_TRUE(file.ok()) << file.error().message();
  const Read back = read(*file, 3);
  EXPECT_EQ(back.size, encoded_size);
  EXPECT_EQ(back.channels, 3);
  ASSERT_EQ(back.pixels.size(), pixels.size());
  int worst = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    worst = std::max(worst, std::abs(std::to_integer<int>(back.pixels[i]) - std::to_integer<int>(pixels[i])));
  EXPECT_LE(worst, 17);
}

// Drawn images are mostly smooth: what no row of a slope needs is not in the file.
TEST(EncodeImage, PngOfASlopeIsSmall) {
  const auto file = encode_png(encoded_size, slopes());
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_LT(file->size(), slopes().size() / 4);
}

}  // namespace
}  // namespace aspic
