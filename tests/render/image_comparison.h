#pragma once
// Pictures held against golden files.
#include <cstddef>
#include <string>
#include <vector>

namespace aspic::test {

/// RGB, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::byte> rgb;

  int channel(int x, int y, int c) const {
    return std::to_integer<int>(
        rgb[3 * static_cast<std::size_t>(y * width + x) + static_cast<std::size_t>(c)]);
  }
};

/// Fails the test if any channel of any pixel differs by more than `tolerance` of 255 from
/// tests/golden/NAME.png; the picture and the differences (eight times as bright) are then written where the
/// message says. With the environment variable ASPIC_UPDATE_GOLDEN set, the golden file is written instead,
/// and the test fails, so that no one leaves it set.
void expect_golden(const Image& image, const std::string& name, int tolerance);

}  // namespace aspic::test
