#pragma once
// Marks on particles that somebody points at, pulls or pins.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/buffer.h"
#include "render/layout.h"
#include "render/model_buffers.h"
#include "render/programs.h"

namespace aspic {

/// What is marked. Particles are the model's.
struct HighlightOptions {
  /// A particle and the point that it is pulled towards.
  struct Pull {
    std::uint32_t particle = 0;
    Vec3 anchor;  ///< [m]
    friend bool operator==(const Pull&, const Pull&) = default;
  };
  std::optional<std::uint32_t> hovered = {};  ///< gets a ring
  std::optional<Pull> pull = {};              ///< a band, and a disc with a cross at the anchor
  std::vector<std::uint32_t> marked = {};     ///< get a diamond, as those do that somebody has pinned by hand
  bool pinned = true;                         ///< where particles are drawn, pinned ones get a small diamond
  double unit = 1.0;                          ///< what marks are measured in [pixels of the image], > 0

  friend bool operator==(const HighlightOptions&, const HighlightOptions&) = default;
};

/// Draws marks at their particles' places in the particle buffer. Its context must outlive it and be current.
class HighlightPainter {
 public:
  /// Errors: those of Buffer.
  static Result<std::unique_ptr<HighlightPainter>> create(
      const std::shared_ptr<RenderProgram::Source>& source);

  /// Draws into an unfinished image whose frame block is bound and whose depth is complete: marks are faint
  /// where something hides them. Leaves blending off. Error (scene_rejected): no device memory.
  Status draw_within(const ModelBuffers& model, const gl::Buffer& particles, const DrawSettings& draw,
                     const HighlightOptions& options);
  /// Draws over a finished image in a framebuffer that takes encoded values, all in sight; `frame` is the
  /// block of its size. Leaves blending off. Error (scene_rejected): no device memory.
  Status draw_over(const ModelBuffers& model, const gl::Buffer& particles, const DrawSettings& draw,
                   const HighlightOptions& options, const render_layout::Frame& frame);

 private:
  /// How a round of marks is drawn.
  struct Tone {
    double opacity = 1.0;
    bool encoded = false;
  };
  explicit HighlightPainter(gl::Context& context) : context_(&context) {}
  Status list(const std::vector<std::uint32_t>& marked);
  void draw_all(const ModelBuffers& model, const gl::Buffer& particles, const DrawSettings& draw,
                const HighlightOptions& options, const Tone& tone) const;

  gl::Context* context_;
  RenderProgram marks_, pull_;
  gl::Buffer frame_, list_;
  std::vector<std::uint32_t> listed_;
};

}  // namespace aspic
