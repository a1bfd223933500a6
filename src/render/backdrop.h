#pragma once
// Everything that does not move, drawn once and kept while it looks the same.
#include <optional>
#include <vector>

#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/color_map.h"
#include "render/layout.h"
#include "render/programs.h"
#include "render/targets.h"

namespace aspic {

/// What the surroundings look like in an image, as far as images differ.
struct BackdropLook {
  BackdropLook(const render_layout::Frame& frame, const std::vector<Terrain>& terrain,
               const std::optional<Color>& background, int samples);

  render_layout::Frame frame;    ///< without what only bodies read
  std::vector<Terrain> terrain;  ///< where it is
  std::optional<Color> background;
  int samples;
  friend bool operator==(const BackdropLook& a, const BackdropLook& b);
};

/// Opaque terrain and sky without anyone's shadow, of one look.
class Backdrop {
 public:
  /// Tells it the look of the image that comes next. Whether images may begin with the backdrop: the look
  /// is that of the image before, so that it is worth keeping.
  bool stays(const BackdropLook& look);
  /// The look is drawn, or is not.
  bool drawn() const { return drawn_; }
  void forget();

  /// Images like these, to be drawn: the surroundings go into the samples, whose framebuffer is bound.
  /// Errors: those of ImageTargets.
  Status begin(gl::Context& context, const ImageTargets& like);
  /// They are drawn: makes the rest of them.
  void finish();

  /// Puts samples and depth of these boxes, or the finished image everywhere, into an image's images.
  void put_samples(ImageTargets& targets, const std::vector<gl::PixelBox>& boxes) const;
  void put_image(ImageTargets& targets) const;

 private:
  std::optional<BackdropLook> look_;
  std::optional<ImageTargets> images_;
  bool drawn_ = false;
};

/// What is behind translucent bodies: the samples at half size, where they are within these boxes.
void halve_samples(const RenderPrograms& programs, const gl::VertexArray& nothing,
                   const ImageTargets& targets, const std::vector<gl::PixelBox>& boxes);
/// The image: the samples' means, where they are within these boxes.
void resolve_samples(const ImageTargets& targets, const std::vector<gl::PixelBox>& boxes);

}  // namespace aspic
