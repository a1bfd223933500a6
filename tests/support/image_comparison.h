#pragma once
// Images held against golden files.
#include <cstddef>
#include <optional>
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

/// An image as golden files hold it: half as wide and high, each channel the mean of four pixels, rounded to
/// an even number. Width and height of the image are even.
Image golden_form(const Image& image);

/// A PNG file's image; of no size if there is none.
Image read_image(const std::string& path);

/// What of an image is not as in a golden one, in a sentence; nothing where they agree. docs/images.md
/// (section "Golden images") derives the two bounds: on each pixel of the golden image, and on the mean
/// of each square of 8 × 8. `difference`: how far apart they are, eight times as bright.
std::optional<std::string> difference_from(const Image& golden, const Image& image,
                                           Image* difference = nullptr);

/// Fails the test unless the image agrees with tests/golden/NAME.png; image and difference are then
/// written where the message says. With the environment variable ASPIC_UPDATE_GOLDEN set, the golden file is
/// written instead where they do not agree, and the test fails, so that no one leaves it set.
void expect_golden(const Image& image, const std::string& name);

}  // namespace aspic::test
