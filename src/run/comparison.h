#pragma once
// Several runs of one scene, each with a difference, in one picture.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "aspic/solver.h"
#include "base/result.h"
#include "io/film_format.h"
#include "render/colour_map.h"
#include "render/overlay.h"
#include "render/targets.h"
#include "run/variant.h"

namespace aspic {

/// Most runs in a picture.
inline constexpr std::size_t most_compared = 4;

/// KEY=VALUE as a difference. Error (usage): a part is missing.
Result<Difference> parse_difference(const std::string& text);

/// The run of the scene itself, and a variant for each KEY=VALUE, each with that difference alone. Errors:
/// usage, more than most_compared runs, or no KEY=VALUE; those of varied(), which then say which one it is.
Result<std::vector<Variant>> variants_of(const Scene& scene, const BackendChoice& backend,
                                         const std::vector<Difference>& differences);

/// How a run differs from the others: a line for each key that differs in one of them, once.
/// `backend`: what computes this one.
std::vector<OverlayLine> label_of(const std::vector<Difference>& differences, const Scene& scene,
                                  const std::string& backend);

/// The colours of runs in pictures and plots, as sRGB stores them.
inline constexpr std::array<std::array<std::uint8_t, 3>, most_compared> run_colours = {
    {{242, 176, 92}, {110, 165, 240}, {120, 205, 140}, {224, 130, 200}}};
/// The same in linear light, for bodies that are coloured by material.
Colour run_tint(std::size_t run);

/// What distinguishes run `run` from the others, in few words: "implicit Euler", "h 0.0005 s". Of the first
/// all values that others differ in. `scene` and `backend` are its own; run ≤ differences.size().
std::string short_name(std::size_t run, const std::vector<Difference>& differences, const Scene& scene,
                       const std::string& backend);

/// The text on the picture of a run: its name in its colour with its time [s], and that it diverged, if it
/// did.
std::vector<OverlayLine> comparison_text(const std::string& name, std::size_t run, double time,
                                         double timestep, const std::optional<Divergence>& divergence);

/// The same for the first part of a picture, below a line with the scene's author if it names one.
std::vector<OverlayLine> below_author(const Scene& scene, std::vector<OverlayLine> text);

/// Height of the text on the parts of a picture of that height, which so many runs share [pixels].
int comparison_text_height(int picture_height, std::size_t runs);

/// A run's part of a picture [pixels from left and top].
struct Tile {
  int left = 0, top = 0, width = 1, height = 1;
  friend bool operator==(const Tile&, const Tile&) = default;
};

/// The parts of 1 to most_compared runs, all of one size, with two or three pixels between them: two side by
/// side, in a picture that is higher than wide one above the other; three and four in two rows.
std::vector<Tile> tiles_of(const PictureSize& picture, std::size_t runs);

/// A picture with a part for each run.
class ComparisonCanvas {
 public:
  /// Error (scene_rejected): no device memory. The context must outlive it and be current in every call.
  static Result<ComparisonCanvas> create(gl::Context& context, const PictureSize& size);
  /// For so many runs from now on. Clears it where that changes something.
  void divide(std::size_t runs);
  const std::vector<Tile>& tiles() const { return tiles_; }
  /// Puts the picture of a run, which has the size of its tile, into its place; with a frame in its colour.
  void place(std::size_t run, const gl::Framebuffer& picture, bool framed);
  const gl::Framebuffer& picture() const { return image_.framebuffer; }

 private:
  DrawableImage image_;
  std::vector<Tile> tiles_;
};

/// FILE with a run's number before its ending: `energy-2.csv`.
std::string numbered_path(const std::string& path, std::size_t number);

}  // namespace aspic
