#include "support/image_comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <spng.h>
#include <stb_image.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

namespace aspic::test {
namespace {

/// Of 255: 1 for the rasterizer's rounding, 1 for that of golden files to even numbers.
constexpr double tolerance = 2.0;
/// Of the contrast around a pixel: what one of four samples changes at most, a quarter of white in sRGB.
constexpr double contrast_share = 137.0 / 255.0;
/// What an edge may move [pixels of the golden image]: a quarter of a drawn pixel, as far as samples are
/// apart.
constexpr double edge_shift = 1.0 / 8.0;
constexpr int square = 8, stride = square / 2;

/// Smallest file, whatever time it takes.
void write(const std::string& path, const Image& image) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> context(spng_ctx_new(SPNG_CTX_ENCODER),
                                                                    &spng_ctx_free);
  spng_ihdr header = {};
  header.width = static_cast<std::uint32_t>(image.width);
  header.height = static_cast<std::uint32_t>(image.height);
  header.bit_depth = 8;
  header.color_type = SPNG_COLOR_TYPE_TRUECOLOR;
  ASSERT_EQ(spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1), 0);
  ASSERT_EQ(spng_set_option(context.get(), SPNG_FILTER_CHOICE, SPNG_FILTER_CHOICE_ALL), 0);
  ASSERT_EQ(spng_set_option(context.get(), SPNG_IMG_COMPRESSION_LEVEL, 9), 0);
  ASSERT_EQ(spng_set_ihdr(context.get(), &header), 0);
  ASSERT_EQ(spng_encode_image(context.get(), image.rgb.data(), image.rgb.size(), SPNG_FMT_PNG,
                              SPNG_ENCODE_FINALIZE),
            0);
  std::size_t size = 0;
  int failed = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(spng_get_png_buffer(context.get(), &size, &failed),
                                                          &std::free);
  ASSERT_EQ(failed, 0);
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(bytes.get()), static_cast<std::streamsize>(size));
  ASSERT_TRUE(file.flush()) << path;
}

/// Mean of the four pixels of a drawn image that become one of a golden one.
double mean_of_four(const Image& image, int x, int y, int c) {
  return 0.25 * (image.channel(2 * x, 2 * y, c) + image.channel(2 * x + 1, 2 * y, c) +
                 image.channel(2 * x, 2 * y + 1, c) + image.channel(2 * x + 1, 2 * y + 1, c));
}

/// Largest minus smallest value of a channel there and in the pixels around it.
int contrast(const Image& image, int x, int y, int c) {
  int least = 255, most = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i) {
      least = std::min(least, image.channel(i, j, c));
      most = std::max(most, image.channel(i, j, c));
    }
  return most - least;
}

/// What a channel changes between two pixels next to each other; 0 where the second is outside.
int step(const Image& image, int x, int y, int dx, int dy, int c) {
  const int i = std::clamp(x + dx, 0, image.width - 1), j = std::clamp(y + dy, 0, image.height - 1);
  return std::abs(image.channel(i, j, c) - image.channel(x, y, c));
}

/// Squares whose mean is further off than rounding and edges that move a little explain.
class Squares {
 public:
  Squares(const Image& golden, const Image& image) : golden_(golden), image_(image) {
    for (int y = 0; y < golden.height; y += stride)
      for (int x = 0; x < golden.width; x += stride)
        for (int c = 0; c < 3; ++c) look_at(x, y, c);
  }
  int count = 0;
  double worst = 0.0;  ///< distance of means
  int worst_x = 0, worst_y = 0;

 private:
  void look_at(int left, int top, int c) {
    const int right = std::min(left + square, golden_.width), bottom = std::min(top + square, golden_.height);
    // Where everything moves by a pixel, a sum over the square changes by at most the steps within it and
    // across its border.
    double off = 0.0, steps = 0.0;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        off += mean_of_four(image_, x, y, c) - golden_.channel(x, y, c);
        steps += step(golden_, x, y, 1, 0, c) + step(golden_, x, y, 0, 1, c);
        if (x == left) steps += step(golden_, x, y, -1, 0, c);
        if (y == top) steps += step(golden_, x, y, 0, -1, c);
      }
    const double pixels = (right - left) * (bottom - top);
    if (std::abs(off) <= tolerance * pixels + edge_shift * steps) return;
    ++count;
    if (std::abs(off) / pixels <= worst) return;
    worst = std::abs(off) / pixels;
    worst_x = 2 * left, worst_y = 2 * top;
  }

  const Image& golden_;
  const Image& image_;
};

}  // namespace

Image read_image(const std::string& path) {
  Image image;
  int channels = 0;
  stbi_uc* const bytes = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
  if (bytes == nullptr) return {};
  const auto all = std::as_bytes(std::span(bytes, 3 * static_cast<std::size_t>(image.width * image.height)));
  image.rgb.assign(all.begin(), all.end());
  stbi_image_free(bytes);
  return image;
}

Image golden_form(const Image& image) {
  Image golden{image.width / 2, image.height / 2, {}};
  for (int y = 0; y < golden.height; ++y)
    for (int x = 0; x < golden.width; ++x)
      for (int c = 0; c < 3; ++c)
        // 255 is rounded to 254, the largest even number of eight bits.
        golden.rgb.push_back(static_cast<std::byte>(
            std::min(254, 2 * static_cast<int>(0.5 * mean_of_four(image, x, y, c) + 0.5))));
  return golden;
}

std::optional<std::string> difference_from(const Image& golden, const Image& image, Image* difference) {
  int pixels = 0, worst_x = 0, worst_y = 0;
  double worst = 0.0;
  if (difference) *difference = golden;
  for (int y = 0; y < golden.height; ++y)
    for (int x = 0; x < golden.width; ++x) {
      bool found = false;
      for (int c = 0; c < 3; ++c) {
        const double off = std::abs(mean_of_four(image, x, y, c) - golden.channel(x, y, c));
        if (difference)
          difference->rgb[3 * static_cast<std::size_t>(y * golden.width + x) + static_cast<std::size_t>(c)] =
              static_cast<std::byte>(std::min(255.0, 8.0 * off));
        if (off <= tolerance + contrast_share * contrast(golden, x, y, c)) continue;
        found = true;
        if (off > worst) worst = off, worst_x = 2 * x, worst_y = 2 * y;
      }
      pixels += found ? 1 : 0;
    }
  const Squares squares(golden, image);
  if (pixels == 0 && squares.count == 0) return {};
  std::string text;
  if (pixels > 0)
    text = fmt::format("{} pixels differ by more than edges explain, the worst by {:.1f}/255 at ({}, {})",
                       pixels, worst, worst_x, worst_y);
  if (squares.count > 0)
    text += fmt::format(
        "{}the means of {} squares of {} × {} pixels differ by more than edges explain, the worst "
        "by {:.1f}/255 at ({}, {})",
        text.empty() ? "" : ", and ", squares.count, 2 * square, 2 * square, squares.worst, squares.worst_x,
        squares.worst_y);
  return text;
}

void expect_golden(const Image& image, const std::string& name) {
  const std::string golden_path = std::string(ASPIC_GOLDEN) + "/" + name + ".png";
  const std::string actual_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + ".png";
  const std::string difference_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + "-difference.png";
  const Image golden = read_image(golden_path);
  const bool there = 2 * golden.width == image.width && 2 * golden.height == image.height;
  Image difference;
  const auto found =
      there ? difference_from(golden, image, &difference) : "it is missing or has another size";
  if (!found) return;
  if (std::getenv("ASPIC_UPDATE_GOLDEN")) {
    write(golden_path, golden_form(image));
    ADD_FAILURE() << "wrote " << golden_path << ": look at it, then run without ASPIC_UPDATE_GOLDEN";
    return;
  }
  write(actual_path, image);
  if (there) write(difference_path, difference);
  ADD_FAILURE() << golden_path << ": " << *found << "; the image is " << actual_path
                << (there ? ", the difference " + difference_path : "")
                << ". If the change is meant, run with ASPIC_UPDATE_GOLDEN=1.";
}

}  // namespace aspic::test
