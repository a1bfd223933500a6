#pragma once
// Frames of one run, or of several side by side, from states on the device.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "aspic/files.h"
#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "gpu/context.h"
#include "model/model.h"
#include "render/overlay.h"
#include "render/quantity.h"
#include "render/renderer.h"
#include "render/tiles.h"

namespace aspic {

/// A run to render; scene and model must outlive the painter.
struct RenderedRun {
  const Scene* scene = nullptr;
  const Model* model = nullptr;
};

/// Everything that a frame shows of a run besides its state.
struct RunView {
  CameraSettings camera;          ///< after it followed a body, fitted to the run's part of the frame
  std::vector<OverlayLine> text;  ///< empty: no panel
  int text_height = 0;            ///< [pixels]; 0: a share of the frame's height
  bool legend = true;
  std::optional<Color> tint = {};  ///< as ImageOptions::tint
  bool framed = false;             ///< with a border in the run's color, where there are several runs
  ArrowSet arrows;
  std::vector<BallTurn> ball_turns;  ///< as ImageOptions::ball_turns
  std::vector<double> channels;      ///< as ImageOptions::channels
};

/// Uploads the state of a solver that works in memory. Errors: those of Solver::read_into() and
/// Renderer::upload().
Result<DeviceState> upload(Renderer& renderer, Solver& solver);

/// Renders frames of one size with 1 to most_compared runs. The context must outlive it; every call enters it
/// (gpu/current.h).
class FramePainter {
 public:
  /// Errors: those of Renderer::create() and set_model(), and of images.
  static Result<std::unique_ptr<FramePainter>> create(gl::Context& context, const ImageSize& size,
                                                      const std::vector<RenderedRun>& runs);

  std::size_t runs() const { return parts_.size(); }
  /// The renderer of run `i`, for upload().
  Renderer& renderer(std::size_t i) { return *parts_[i].renderer; }

  /// Renders the runs' states. Scales that several runs share get the range that all of them need. A part
  /// whose step and text are unchanged since the previous frame is not rendered again. Errors: those of
  /// Renderer::draw().
  Status draw(const std::vector<DeviceState>& states, const std::vector<RunView>& views);
  /// The latest frame. Legal after draw().
  const gl::Framebuffer& frame() const;

 private:
  struct Part {
    RenderedRun run;
    std::unique_ptr<Renderer> renderer;
    std::optional<std::uint64_t> step = {};  // of what follows
    QuantityRange own_range = {};
    std::optional<QuantityRange> drawn_range = {};
    std::vector<OverlayLine> drawn_text = {};
  };
  FramePainter() = default;
  Status draw_part(Part& part, int width, int height, const DeviceState& state, const RunView& view,
                   const std::optional<QuantityRange>& range);

  gl::Context* context_ = nullptr;
  ImageSize size_;
  std::vector<Part> parts_;
  std::optional<ComparisonCanvas> together_;  // of several runs
};

}  // namespace aspic
