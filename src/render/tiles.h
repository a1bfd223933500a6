#pragma once
// Several runs side by side in one frame: their places, colors and text.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aspic/files.h"
#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "render/color_map.h"
#include "render/overlay.h"
#include "render/targets.h"

namespace aspic {

/// Most runs in a frame.
inline constexpr std::size_t most_compared = 4;

/// Colors of runs in frames and plots, as sRGB stores them.
inline constexpr std::array<std::array<std::uint8_t, 3>, most_compared> run_colors = {
    {{242, 176, 92}, {110, 165, 240}, {120, 205, 140}, {224, 130, 200}}};
/// The same in linear light, for bodies that are colored by material.
Color run_tint(std::size_t run);

/// Text on the part of a run: its name in its color, its time [s], and its divergence if there is one.
std::vector<OverlayLine> comparison_text(const std::string& name, std::size_t run, double time,
                                         double timestep, const std::optional<Divergence>& divergence);

/// The same for the first part of a frame, below a line with the scene's author if it names one.
std::vector<OverlayLine> below_author(const Scene& scene, std::vector<OverlayLine> text);

/// Height of the text on the parts of a frame of that height with this number of runs [pixels].
int comparison_text_height(int frame_height, std::size_t runs);

/// A run's part of a frame [pixels from left and top].
struct Tile {
  int left = 0, top = 0, width = 1, height = 1;
  friend bool operator==(const Tile&, const Tile&) = default;
};

/// The parts of 1 to most_compared runs, all of one size, two or three pixels apart: two side by side, or
/// one above the other in a frame that is higher than wide; three and four in two rows.
std::vector<Tile> tiles_of(const ImageSize& frame, std::size_t runs);

/// A frame with a part for each run.
class ComparisonCanvas {
 public:
  /// Error (scene_rejected): no device memory. The context must outlive it and be current in every call.
  static Result<ComparisonCanvas> create(gl::Context& context, const ImageSize& size);
  /// Sets the number of runs. Clears the frame if that changes the parts.
  void divide(std::size_t runs);
  const std::vector<Tile>& tiles() const { return tiles_; }
  /// Copies the image of a run, which has the size of its tile, to its place. `framed`: with a border in the
  /// run's color.
  void place(std::size_t run, const gl::Framebuffer& image, bool framed);
  const gl::Framebuffer& frame() const { return image_.framebuffer; }

 private:
  DrawableImage image_;
  std::vector<Tile> tiles_;
};

}  // namespace aspic
