#pragma once
// What of an image stays as it is while bodies move, for software rasterizers: for a renderer's own sources
// alone.
#include <vector>

#include "render/backdrop.h"
#include "render/moving_part.h"
#include "render/renderer_parts.h"

namespace aspic {

/// Hardware does without: what it would save there is little.
class Renderer::Parts::Surroundings {
 public:
  /// There is another model.
  void reset(const Model& another);
  /// Whether the image may begin with the backdrop, which is drawn if need be.
  bool prepare(Parts& parts, const Drawing& drawing);
  /// Puts the backdrop's samples, where the image differs from it, or its image into the targets.
  void put_samples(ImageTargets& to, const std::vector<gl::PixelBox>& boxes) const {
    backdrop_.put_samples(to, boxes);
  }
  void put_image(ImageTargets& to) const { backdrop_.put_image(to); }
  /// Where the image differs from its backdrop.
  std::vector<gl::PixelBox> changing(const Parts& parts, const Drawing& drawing) const;
  /// Where translucent bodies are, and as far around them as they bend sight (shaders/render/jelly.frag).
  std::vector<gl::PixelBox> around_flesh(const Parts& parts, const DeviceState& state) const;

 private:
  Backdrop backdrop_;
  Extent rods_;
};

}  // namespace aspic
