#include "render/image_comparison.h"

#include <gtest/gtest.h>
#include <stb_image.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace aspic::test {
namespace {

void write(const std::string& path, const Image& image) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  ASSERT_NE(stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width), 0)
      << path;
}

}  // namespace

void expect_golden(const Image& image, const std::string& name, int tolerance) {
  const std::string golden_path = std::string(ASPIC_GOLDEN) + "/" + name + ".png";
  if (std::getenv("ASPIC_UPDATE_GOLDEN")) {
    write(golden_path, image);
    ADD_FAILURE() << "wrote " << golden_path << ": look at it, then run without ASPIC_UPDATE_GOLDEN";
    return;
  }
  const std::string actual_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + ".png";
  const std::string difference_path = std::string(ASPIC_GOLDEN_FAILURES) + "/" + name + "-difference.png";
  int width = 0, height = 0, channels = 0;
  stbi_uc* golden = stbi_load(golden_path.c_str(), &width, &height, &channels, 3);
  if (golden == nullptr || width != image.width || height != image.height) {
    write(actual_path, image);
    stbi_image_free(golden);
    ADD_FAILURE() << golden_path << " is missing or has another size; the picture is in " << actual_path
                  << ". Run this test with ASPIC_UPDATE_GOLDEN=1 to take it as golden.";
    return;
  }
  Image difference = image;
  int failing = 0, largest = 0;
  for (std::size_t pixel = 0; pixel < image.rgb.size(); pixel += 3) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int off =
          std::abs(std::to_integer<int>(image.rgb[pixel + c]) - static_cast<int>(golden[pixel + c]));
      difference.rgb[pixel + c] = static_cast<std::byte>(std::min(255, 8 * off));
      worst = std::max(worst, off);
    }
    failing += worst > tolerance;
    largest = std::max(largest, worst);
  }
  stbi_image_free(golden);
  if (failing == 0) return;
  write(actual_path, image);
  write(difference_path, difference);
  ADD_FAILURE() << failing << " pixels of " << name << " differ from the golden picture by more than "
                << tolerance << "/255, the worst by " << largest << "; see " << actual_path << " and "
                << difference_path << ". If the change is meant, run with ASPIC_UPDATE_GOLDEN=1.";
}

}  // namespace aspic::test
