#pragma once
// The frames of a run from its states to its files.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/frame_painter.h"
#include "run/recording.h"
#include "run/run_files.h"

namespace aspic {

/// A state to render.
struct RenderedState {
  Solver* solver = nullptr;  ///< that is at the state
  DeviceState there = {};    ///< where the state lies on the device; without particles: in memory
};

/// Renders the frames of a video and hands them to a recording, in order.
class VideoPainter {
 public:
  /// The context, and what the runs refer to, must outlive it. Errors: those of FramePainter::create() and
  /// Recording::start().
  static Result<std::unique_ptr<VideoPainter>> create(gl::Context& context, const ImageOutput& output,
                                                      std::vector<RenderedRun> runs,
                                                      std::vector<std::unique_ptr<FrameSink>> sinks);

  /// Adds a frame of the runs' states, `copies` ≥ 1 times; they may change afterwards. Errors: those of
  /// rendering; once all outputs are lost, the encoder's.
  Status add(const std::vector<RenderedState>& states, const std::vector<RunView>& views,
             std::uint64_t copies);
  /// All frames are added: completes the outputs. Errors as add().
  Status finish();
  /// Ends without videos; frames in directories stay.
  void abandon() { recording_->abandon(); }

  Recording& recording() { return *recording_; }
  const Recording& recording() const { return *recording_; }
  /// With the time spent on rendering and reading back.
  FrameTimes times() const;
  /// GL_RENDERER of the device that renders.
  const std::string& device() const { return context_->info().renderer; }

 private:
  explicit VideoPainter(gl::Context& context) : context_(&context) {}

  gl::Context* context_;
  double draw_seconds_ = 0.0;
  std::unique_ptr<FramePainter> painter_;
  std::unique_ptr<Recording> recording_;
};

}  // namespace aspic
