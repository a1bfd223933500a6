#include "run/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/printable.h"
#include "render/overlay_text.h"
#include "scene/short_keys.h"

namespace aspic {

Result<Difference> parse_difference(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return fail(ErrorCode::usage,
                "\"{}\" is not KEY=VALUE, such as integrator=implicit-euler, h=0.002, k=500, "
                "backend=reference or any key of the scene.",
                printable_line(text));
  return Difference{text.substr(0, equals), text.substr(equals + 1)};
}

Result<std::vector<Variant>> variants_of(const Scene& scene, const BackendChoice& backend,
                                         const std::vector<Difference>& differences) {
  if (differences.size() >= most_compared)
    return fail(ErrorCode::usage,
                "{} differences are given; at most {} runs are compared with the scene's own.",
                differences.size(), most_compared - 1);
  std::vector<Variant> runs = {{scene, backend}};
  for (const Difference& difference : differences) {
    auto run = varied(scene, backend, std::span(&difference, 1));
    if (!run) {
      return fail(run.error(), "the variant {}={} cannot be run:\n{}", printable_line(difference.key),
                  printable_line(difference.value), run.error().what);
    }
    runs.push_back(std::move(*run));
  }
  return runs;
}

std::vector<OverlayLine> label_of(const std::vector<Difference>& differences, const Scene& scene,
                                  const std::string& backend) {
  std::vector<OverlayLine> label;
  for (const Difference& difference : differences) {
    const std::string title = title_of(difference.key);
    if (std::ranges::find(label, title, &OverlayLine::label) == label.end())
      label.push_back({title, value_of(difference.key, scene, backend)});
  }
  return label;
}

Colour run_tint(std::size_t run) {
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<float>(srgb_to_linear(run_colours[run][c] / 255.0));
  return colour;
}

namespace {

/// "implicit Euler", "h 0.0005 s", "shear stiffness 20 N/m".
std::string short_difference(const std::string& key, const Scene& scene, const std::string& backend) {
  const std::string value = value_of(key, scene, backend);
  if (key == backend_key || key == "integrator" || key == "simulation.integrator") return value;
  std::string name = title_of(key);
  // The symbol of a short name; of a path what is after its table.
  if (find_short_key(key)) {
    name = name.substr(name.rfind(' ') + 1);
  } else {
    const std::size_t list = name.find("].");
    name = name.substr(list == std::string::npos ? name.find('.') + 1 : list + 2);
    std::ranges::replace(name, '.', ' ');
    std::ranges::replace(name, '-', ' ');
  }
  return fmt::format("{} {}", name, value);
}

}  // namespace

std::string short_name(std::size_t run, const std::vector<Difference>& differences, const Scene& scene,
                       const std::string& backend) {
  if (run > 0) return short_difference(differences[run - 1].key, scene, backend);
  std::vector<std::string> parts;
  for (const Difference& difference : differences) {
    std::string part = short_difference(difference.key, scene, backend);
    if (std::ranges::find(parts, part) == parts.end()) parts.push_back(std::move(part));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
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

int comparison_text_height(int picture_height, std::size_t runs) {
  return std::clamp(picture_height / (runs > 2 ? 40 : 32), 11, 256);
}

std::vector<Tile> tiles_of(const PictureSize& picture, std::size_t runs) {
  constexpr int gap = 2;
  const bool wide = picture.width >= picture.height;
  const int columns = runs > 2 || (runs == 2 && wide) ? 2 : 1;
  const int rows = runs > 2 || (runs == 2 && !wide) ? 2 : 1;
  const auto part = [](int whole, int parts) { return parts == 1 ? whole : std::max((whole - gap) / 2, 1); };
  const int width = part(picture.width, columns), height = part(picture.height, rows);
  std::vector<Tile> tiles;
  for (int i = 0; i < static_cast<int>(runs); ++i) {
    const bool right = i % columns == 1, low = i / columns == 1;
    tiles.push_back({right ? picture.width - width : 0, low ? picture.height - height : 0, width, height});
  }
  return tiles;
}

Result<ComparisonCanvas> ComparisonCanvas::create(gl::Context& context, const PictureSize& size) {
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

void ComparisonCanvas::place(std::size_t run, const gl::Framebuffer& picture, bool framed) {
  const gl::Framebuffer& whole = image_.framebuffer;
  const Tile& tile = tiles_[run];
  const int bottom = whole.height() - tile.top - tile.height, right = tile.left + tile.width,
            top = bottom + tile.height;
  whole.place(picture, tile.left, bottom);
  if (!framed) return;
  const int wide = std::max(whole.height() / 240, 1);
  std::array<float, 3> colour;
  for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<float>(run_colours[run][c]) / 255.0f;
  for (const gl::PixelBox& edge : {gl::PixelBox{tile.left, bottom, tile.left + wide, top},
                                   {right - wide, bottom, right, top},
                                   {tile.left, bottom, right, bottom + wide},
                                   {tile.left, top - wide, right, top}})
    whole.fill(edge, colour);
}

std::string numbered_path(const std::string& path, std::size_t number) {
  std::filesystem::path numbered(path);
  const std::string name =
      fmt::format("{}-{}{}", numbered.stem().string(), number, numbered.extension().string());
  return numbered.replace_filename(name).string();
}

}  // namespace aspic
