#pragma once
// The pictures of one run, or of several side by side, from states that somebody else knows.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "gpu/context.h"
#include "io/film_format.h"
#include "model/model.h"
#include "render/overlay.h"
#include "render/quantity.h"
#include "render/renderer.h"
#include "run/comparison.h"

namespace aspic {

/// A run as its pictures need it; scene and model must outlive whoever draws them.
struct PaintedRun {
  const Scene* scene = nullptr;
  const Model* model = nullptr;
};

/// What a picture shows of a run besides its state.
struct ShownRun {
  CameraSettings camera;          ///< as it has moved along, fitted to the run's part of the picture
  std::vector<OverlayLine> text;  ///< empty: no panel
  int text_height = 0;            ///< [pixels]; 0: a share of the picture's height
  bool legend = true;
  std::optional<Colour> tint = {};  ///< as PictureOptions::tint
  bool framed = false;              ///< in the run's colour, where there are several runs
  ArrowSet arrows;
  std::vector<BallTurn> ball_turns;  ///< as PictureOptions::ball_turns
  std::vector<double> channels;      ///< as PictureOptions::channels
};

/// Brings the state of a solver that works in memory to the device. Errors: those of Solver::read_into() and
/// Renderer::upload().
Result<DeviceState> upload(Renderer& renderer, Solver& solver);

/// Draws pictures of one size, which one to most_compared runs share. The context must outlive it; every call
/// enters it (gpu/current.h).
class PicturePainter {
 public:
  /// Errors: those of Renderer::create() and set_model(), and of images.
  static Result<std::unique_ptr<PicturePainter>> create(gl::Context& context, const PictureSize& size,
                                                        const std::vector<PaintedRun>& runs);

  std::size_t runs() const { return parts_.size(); }
  /// What run `i` is drawn with: for states that are brought to the device.
  Renderer& renderer(std::size_t i) { return *parts_[i].renderer; }

  /// Draws the runs' states; where there are several, the scales that they share have the range that all
  /// need. A part is not drawn again if its step and its text are those of the picture before. Errors: those
  /// of Renderer::draw().
  Status draw(const std::vector<DeviceState>& states, const std::vector<ShownRun>& shown);
  /// The picture drawn last. Legal after draw().
  const gl::Framebuffer& picture() const;

 private:
  struct Part {
    PaintedRun run;
    std::unique_ptr<Renderer> renderer;
    std::optional<std::uint64_t> step = {};  // of what follows
    QuantityRange own_range = {};
    std::optional<QuantityRange> drawn_range = {};
    std::vector<OverlayLine> drawn_text = {};
  };
  PicturePainter() = default;
  Status draw_part(Part& part, int width, int height, const DeviceState& state, const ShownRun& shown,
                   const std::optional<QuantityRange>& range);

  gl::Context* context_ = nullptr;
  PictureSize size_;
  std::vector<Part> parts_;
  std::optional<ComparisonCanvas> together_;  // of several runs
};

}  // namespace aspic
