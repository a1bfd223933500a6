#pragma once
// Everything that does not move, drawn once and kept while it looks the same.
#include <optional>
#include <vector>

#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/colour_map.h"
#include "render/layout.h"
#include "render/programs.h"
#include "render/targets.h"

namespace aspic {

/// What the surroundings look like in a picture, as far as pictures differ.
struct BackdropLook {
  BackdropLook(const render_layout::Frame& frame, const std::vector<Terrain>& terrain,
               const std::optional<Colour>& background, int samples);

  render_layout::Frame frame;    ///< without what only bodies read
  std::vector<Terrain> terrain;  ///< where it is
  std::optional<Colour> background;
  int samples;
  friend bool operator==(const BackdropLook& a, const BackdropLook& b);
};

/// Opaque terrain and sky without anyone's shadow, of one look.
class Backdrop {
 public:
  /// Tells it the look of the picture that comes next. Whether pictures may begin with the backdrop: the look
  /// is that of the picture before, so that it is worth keeping.
  bool stays(const BackdropLook& look);
  /// The look is drawn, or is not.
  bool drawn() const { return drawn_; }
  void forget();

  /// Images like these, to be drawn: the surroundings go into the samples, whose framebuffer is bound.
  /// Errors: those of PictureTargets.
  Status begin(gl::Context& context, const PictureTargets& like);
  /// They are drawn: makes the rest of them.
  void finish();

  /// Puts samples and depth of these boxes, or the finished picture everywhere, into a picture's images.
  void put_samples(PictureTargets& targets, const std::vector<gl::PixelBox>& boxes) const;
  void put_picture(PictureTargets& targets) const;

 private:
  std::optional<BackdropLook> look_;
  std::optional<PictureTargets> images_;
  bool drawn_ = false;
};

/// What is behind translucent bodies: the samples at half size, where they are within these boxes.
void halve_samples(const RenderPrograms& programs, const gl::VertexArray& nothing,
                   const PictureTargets& targets, const std::vector<gl::PixelBox>& boxes);
/// The picture: the samples' means, where they are within these boxes.
void resolve_samples(const PictureTargets& targets, const std::vector<gl::PixelBox>& boxes);

}  // namespace aspic
