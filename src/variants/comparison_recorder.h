#pragma once
// Records videos of several runs side by side, without a window.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "render/overlay.h"
#include "run/backends.h"
#include "run/run_files.h"
#include "run/video_painter.h"
#include "scene/follow.h"
#include "variants/comparison.h"

namespace aspic {

/// A run to record; the objects it refers to must outlive the recorder.
struct RecordedRun {
  const Scene* scene = nullptr;
  const Backend* backend = nullptr;
  std::string name;  ///< what distinguishes it from the others: short_name()
};

class ComparisonRecorder {
 public:
  /// Renders in `context`, which all backends that need one share. The sinks have the size of `output`.
  /// 1 to most_compared runs. Errors: as Recorder::create().
  static Result<std::unique_ptr<ComparisonRecorder>> create(gl::Context& context, const ImageOutput& output,
                                                            std::vector<RecordedRun> runs,
                                                            std::vector<std::unique_ptr<FrameSink>> sinks);

  /// Adds a frame of the runs' states: run i is at `steps[i]`, and `divergences[i]` is that of the next step,
  /// if there is one. The part of a run that has stopped is not rendered again. Error: also the encoder's,
  /// once all outputs are lost.
  Status add(const std::vector<std::uint64_t>& steps,
             const std::vector<std::optional<Divergence>>& divergences);
  /// Completes the outputs.
  Status finish();
  void abandon() { video_->abandon(); }
  /// Of the outputs that are lost so far; the others continue.
  std::vector<Error> failures() const { return video_->recording().failures(); }
  /// After finish(): the names of the completed outputs.
  std::vector<std::string> written() { return video_->recording().written(); }

  void add_simulation(double seconds) { simulate_seconds_ += seconds; }
  FrameTimes times() const;
  /// GL_RENDERER of the device that renders.
  const std::string& device() const { return video_->device(); }

 private:
  struct Part {
    RecordedRun run;
    std::size_t number = 0;
    Tile tile;
    Following following = {};
    std::optional<std::uint64_t> step = {};  // of what follows
    State copy = {};                         // where it is needed
  };
  ComparisonRecorder() = default;
  Status take_state(Part& part, std::uint64_t step);
  RunView view_of(const Part& part, const std::optional<Divergence>& divergence) const;

  ImageOutput output_;
  std::vector<Part> parts_;
  double simulate_seconds_ = 0.0;
  std::unique_ptr<VideoPainter> video_;
};

}  // namespace aspic
