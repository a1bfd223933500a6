#include "render/image_comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stb_image.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <span>

namespace aspic::test {
namespace {

constexpr int tolerance = 2;                  // of 255
constexpr std::size_t pixels_an_edge = 5000;  // for each that may be on the other side of an edge

void write(const std::string& path, const Image& image) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  ASSERT_NE(stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width), 0)
      << path;
}

/// Nothing if there is no such picture.
Image read(const std::string& path) {
  Image image;
  int channels = 0;
  stbi_uc* const bytes = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
  if (bytes == nullptr) return {};
  const auto all = std::as_bytes(std::span(bytes, 3 * static_cast<std::size_t>(image.width * image.height)));
  image.rgb.assign(all.begin(), all.end());
  stbi_image_free(bytes);
  return image;
}

/// Whether a channel of a pixel is among those that the golden picture has there and up to two pixels beside
/// it.
bool is_beside(const Image& golden, int x, int y, int c, int value) {
  int least = 255, most = 0;
  for (int j = std::max(y - 2, 0); j <= std::min(y + 2, golden.height - 1); ++j)
    for (int i = std::max(x - 2, 0); i <= std::min(x + 2, golden.width - 1); ++i) {
      least = std::min(least, golden.channel(i, j, c));
      most = std::max(most, golden.channel(i, j, c));
    }
  return value >= least - tolerance && value <= most + tolerance;
}

}  // namespace

std::optional<std::string> difference_from(const Image& golden, const Image& image, Image* difference) {
  std::size_t differing = 0, apart = 0;
  int largest = 0;
  if (difference) *difference = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int worst = 0;
      for (int c = 0; c < 3; ++c) {
        const int value = image.channel(x, y, c), off = std::abs(value - golden.channel(x, y, c));
        if (difference)
          difference->rgb[3 * static_cast<std::size_t>(y * image.width + x) + static_cast<std::size_t>(c)] =
              static_cast<std::byte>(std::min(255, 8 * off));
        worst = std::max(worst, off);
      }
      if (worst <= tolerance) continue;
      ++differing;
      bool beside = true;
      for (int c = 0; c < 3; ++c) beside = beside && is_beside(golden, x, y, c, image.channel(x, y, c));
      apart += beside ? 0 : 1;
      largest = std::max(largest, worst);
    }
  const std::size_t allowed = image.rgb.size() / 3 / pixels_an_edge;
  if (apart == 0 && differing <= allowed) return {};
  return fmt::format(
      "{} pixels differ by more than {}/255, the worst by {}; {} of them are not as in the golden picture "
      "beside them, and {} may differ",
      differing, tolerance, largest, apart, allowed);
}

void expect_golden(const Image& image, const std::string& name) {
  const std::string golden_path = std::string(ASPIC_GOLDEN) + "/" + name + ".png";
  if (std::getenv("ASPIC_UPDATE_GOLDEN")) {
    write(golden_path, image);
    ADD_FAILURE() << "wrote " << golden_path << ": look at it, then run without ASPIC_UPDATE_GOLDEN";
    return;
  }
  const std::string actual_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + ".png";
  const std::string difference_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + "-difference.png";
  const Image golden = read(golden_path);
  if (golden.width != image.width || golden.height != image.height) {
    write(actual_path, image);
    ADD_FAILURE() << golden_path << " is missing or has another size; the picture is in " << actual_path
                  << ". Run this test with ASPIC_UPDATE_GOLDEN=1 to take it as golden.";
    return;
  }
  Image difference;
  const auto found = difference_from(golden, image, &difference);
  if (!found) return;
  write(actual_path, image);
  write(difference_path, difference);
  ADD_FAILURE() << name << ": " << *found << "; see " << actual_path << " and " << difference_path
                << ". If the change is meant, run with ASPIC_UPDATE_GOLDEN=1.";
}

}  // namespace aspic::test
