#include "render/tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "render/overlay_text.h"

namespace aspic {

Color run_tint(std::size_t run) {
  Color color;
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<float>(srgb_to_linear(run_colors[run][c] / 255.0));
  return color;
}

std::vector<OverlayLine> comparison_text(const std::string& name, std::size_t run, double time,
                                         double timestep, const std::optional<Divergence>& divergence) {
  std::vector<OverlayLine> text = {{name, fmt::format("{:.3f} s", time), false, run_tint(run)}};
  if (divergence) {
    const double when = static_cast<double>(divergence->step) * timestep;
    text.push_back({"diverged", fmt::format("at {:.3f} s", when), true});
  }
  return text;
}

std::vector<OverlayLine> below_author(const Scene& scene, std::vector<OverlayLine> text) {
  // As one label, which takes several lines where a part is narrow.
  for (const OverlayLine& line : author_lines(scene))
    text.insert(text.begin(), {fmt::format("{} {}", line.label, line.value), ""});
  return text;
}

int comparison_text_height(int frame_height, std::size_t runs) {
  return std::clamp(frame_height / (runs > 2 ? 40 : 32), 11, 256);
}

std::vector<Tile> tiles_of(const ImageSize& frame, std::size_t runs) {
  constexpr int gap = 2;
  const bool wide = frame.width >= frame.height;
  const int columns = runs > 2 || (runs == 2 && wide) ? 2 : 1;
  const int rows = runs > 2 || (runs == 2 && !wide) ? 2 : 1;
  const auto part = [](int whole, int parts) { return parts == 1 ? whole : std::max((whole - gap) / 2, 1); };
  const int width = part(frame.width, columns), height = part(frame.height, rows);
  std::vector<Tile> tiles;
  for (int i = 0; i < static_cast<int>(runs); ++i) {
    const bool right = i % columns == 1, low = i / columns == 1;
    tiles.push_back({right ? frame.width - width : 0, low ? frame.height - height : 0, width, height});
  }
  return tiles;
}

Result<ComparisonCanvas> ComparisonCanvas::create(gl::Context& context, const ImageSize& size) {
  ComparisonCanvas canvas;
  ASPIC_TRY(canvas.image_, DrawableImage::create(context, "runs side by side",
                                                 {.width = size.width, .height = size.height}, false));
  return canvas;
}

void ComparisonCanvas::divide(std::size_t runs) {
  const gl::Framebuffer& whole = image_.framebuffer;
  std::vector<Tile> tiles = tiles_of({whole.width(), whole.height()}, runs);
  if (tiles == tiles_) return;
  tiles_ = std::move(tiles);
  whole.clear();
}

void ComparisonCanvas::place(std::size_t run, const gl::Framebuffer& image, bool framed) {
  const gl::Framebuffer& whole = image_.framebuffer;
  const Tile& tile = tiles_[run];
  const int bottom = whole.height() - tile.top - tile.height, right = tile.left + tile.width,
            top = bottom + tile.height;
  whole.place(image, tile.left, bottom);
  if (!framed) return;
  const int wide = std::max(whole.height() / 240, 1);
  std::array<float, 3> color;
  for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<float>(run_colors[run][c]) / 255.0f;
  for (const gl::PixelBox& edge : {gl::PixelBox{tile.left, bottom, tile.left + wide, top},
                                   {right - wide, bottom, right, top},
                                   {tile.left, bottom, right, bottom + wide},
                                   {tile.left, top - wide, right, top}})
    whole.fill(edge, color);
}

}  // namespace aspic
