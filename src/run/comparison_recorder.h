#pragma once
// Pictures of several runs side by side while they run, without a window.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "render/overlay.h"
#include "run/backends.h"
#include "run/comparison.h"
#include "run/film_painter.h"
#include "run/run_files.h"
#include "scene/follow.h"

namespace aspic {

/// A run as its picture needs it; the objects it refers to must outlive the recorder.
struct PicturedRun {
  const Scene* scene = nullptr;
  const Backend* backend = nullptr;
  std::string name;  ///< what distinguishes it from the others: short_name()
};

class ComparisonRecorder {
 public:
  /// Draws in `context`, the one of all backends that need one. The sinks have the
  /// size of `output`. One to most_compared runs. Errors: as
  /// Recorder::create().
  static Result<std::unique_ptr<ComparisonRecorder>> create(gl::Context& context, const PictureOutput& output,
                                                            std::vector<PicturedRun> runs,
                                                            std::vector<std::unique_ptr<FrameSink>> sinks);

  /// Adds a picture of the runs' states: run i is at `steps[i]`, and diverged in the step after if
  /// `divergences[i]` says so. The part of a run that has stopped is not drawn again. Error: also that of
  /// the encoder, as soon as all outputs are lost.
  Status add(const std::vector<std::uint64_t>& steps,
             const std::vector<std::optional<Divergence>>& divergences);
  /// Completes the outputs.
  Status finish();
  void abandon() { film_->abandon(); }
  /// Of the outputs that are lost so far; the others continue.
  std::vector<Error> failures() const { return film_->recording().failures(); }
  /// After finish(): the names of the completed outputs.
  std::vector<std::string> written() { return film_->recording().written(); }

  void add_simulation(double seconds) { simulate_seconds_ += seconds; }
  FrameTimes times() const;
  /// GL_RENDERER of the drawing context.
  const std::string& device() const { return film_->device(); }

 private:
  struct Part {
    PicturedRun run;
    std::size_t number = 0;
    Tile tile;
    Following following = {};
    std::optional<std::uint64_t> step = {};  // of what follows
    State copy = {};                         // where it is needed
  };
  ComparisonRecorder() = default;
  Status take_state(Part& part, std::uint64_t step);
  ShownRun shown(const Part& part, const std::optional<Divergence>& divergence) const;

  PictureOutput output_;
  std::vector<Part> parts_;
  double simulate_seconds_ = 0.0;
  std::unique_ptr<FilmPainter> film_;
};

}  // namespace aspic
