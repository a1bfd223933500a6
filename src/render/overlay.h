#pragma once
// What is written over an image: a panel of facts, and the scale of the colors.
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "gpu/buffer.h"
#include "gpu/texture.h"
#include "render/camera.h"
#include "render/color_map.h"
#include "render/font.h"
#include "render/programs.h"

namespace aspic {

/// One line of the panel.
struct OverlayLine {
  std::string label;               ///< in the left column, dimmer; may be empty
  std::string value;               ///< in the right column
  bool alarm = false;              ///< it tells of a failure
  std::optional<Color> tint = {};  ///< of the label, linear light; absent: that of all labels
  friend bool operator==(const OverlayLine&, const OverlayLine&) = default;
};

/// Where the panel of facts is in an image [pixels from left and top].
struct FactsPanel {
  float left = 0.0f, top = 0.0f, width = 0.0f, height = 0.0f;
  float labels = 0.0f;  ///< width of the left column, with the gap to the right one
};
FactsPanel facts_panel(const Font& font, const std::vector<OverlayLine>& lines);

/// Height of text in an image of this height, unless another is asked for [pixels].
int text_height_in(int image_height);

/// The lines with labels that are wider than `room` divided between words; the last part has the value.
/// `width` of a text and `room` in one unit.
std::vector<OverlayLine> fitted_lines(const std::vector<OverlayLine>& lines, float room,
                                      const std::function<float(std::string_view)>& width);

/// A scale of colors with its ends, or a key of named colors, bottom right.
struct Legend {
  std::string title;
  ScaleMap map = ScaleMap::violet_yellow;  ///< colors of the scale
  std::array<std::string, 3> marks;        ///< lower end, middle, upper end; all empty: no scale is drawn
  struct Entry {
    Color color;
    std::string name;
  };
  std::vector<Entry> entries;  ///< below the title, instead of a scale
  bool empty() const { return title.empty(); }
};

/// Draws text; knows nothing of scenes. Its context must outlive it and be current.
class OverlayPainter {
 public:
  OverlayPainter(gl::Context& context, RenderProgram program)
      : context_(&context), program_(std::move(program)) {}

  /// Draws over `image`, an sRGB image; text is `text_height` pixels high, if that is 0 a fixed fraction of
  /// the image's height, 11 pixels at least.
  /// The color map must be bound to its unit and the frame block to its binding. Leaves blending off. Error
  /// (scene_rejected): no device memory.
  /// Legends are stacked; empty ones are left out. `camera`: that of axes in the upper right
  /// corner; null: none.
  Status draw(const gl::Framebuffer& image, const std::vector<OverlayLine>& lines,
              std::span<const Legend> legends, const Camera* camera = nullptr, int text_height = 0);

 private:
  struct Vertex {
    std::array<float, 4> place, tint, shape;
  };
  Status prepare_font(int pixel_height);
  void rectangle(float x, float y, float width, float height, const std::array<float, 4>& uv,
                 const std::array<float, 4>& tint, const std::array<float, 4>& shape);
  void panel(float x, float y, float width, float height, float opacity);
  void text(float x, float y, std::string_view utf8, const std::array<float, 4>& tint);
  void facts(const std::vector<OverlayLine>& all, float image_width);
  /// Returns the height it takes, and the gap above it.
  float scale(const Legend& legend, float image_width, float bottom);
  void axes(const Camera& camera, float image_width);
  /// A line with round ends.
  void line(const std::array<float, 2>& from, const std::array<float, 2>& to, float width,
            const std::array<float, 4>& tint);

  gl::Context* context_;
  RenderProgram program_;
  gl::Texture glyphs_;
  std::unique_ptr<Font> font_;
  gl::Buffer vertices_;
  std::vector<Vertex> pending_;
};

}  // namespace aspic
