#pragma once
// Pictures held against golden files.
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

/// What of a picture is not as in a golden one of the same size, in a sentence; nothing where they agree.
/// They agree where no channel differs by more than 2 of 255: another build of the rasteriser rounds
/// otherwise. One pixel in 5,000 may also differ by more, where edges fall by a hair on the other side of a
/// sample on another kind of processor: its channels are within 2 of what the golden picture has up to two
/// pixels beside it. `difference`: how far apart they are, eight times as bright.
std::optional<std::string> difference_from(const Image& golden, const Image& image,
                                           Image* difference = nullptr);

/// Fails the test unless the picture agrees with tests/golden/NAME.png; picture and difference are then
/// written where the message says. With the environment variable ASPIC_UPDATE_GOLDEN set, the golden file is
/// written instead, and the test fails, so that no one leaves it set.
void expect_golden(const Image& image, const std::string& name);

}  // namespace aspic::test
