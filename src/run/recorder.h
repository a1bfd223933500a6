#pragma once
// Pictures of a run while it runs, without a window.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "io/frame_schedule.h"
#include "run/backends.h"
#include "run/film_painter.h"
#include "run/run_files.h"
#include "scene/follow.h"

namespace aspic {

/// Whether the pictures of a run can be counted. Error (usage): speed and pictures per second make more than
/// was meant.
Status check_pictures(const PictureOutput& output, double timestep, std::uint64_t first_step,
                      std::uint64_t last_step);

class Recorder {
 public:
  /// Draws in the backend's context where it has one, else in a separate headless one; the sinks have the
  /// size of `output`. Everything given by reference must outlive the recorder. Errors: no_device,
  /// scene_rejected (no device memory), io (a shader file).
  static Result<std::unique_ptr<Recorder>> create(const PictureOutput& output, const Scene& scene,
                                                  const Backend& backend,
                                                  std::vector<std::unique_ptr<FrameSink>> sinks,
                                                  std::uint64_t first_step, std::uint64_t last_step);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The step that the next picture shows; after the last one, a step that no run reaches.
  std::uint64_t next_step() const;
  /// The solver is at `step` ≤ next_step(): draws every picture that shows it. Error: also that of the
  /// encoder, as soon as all outputs are lost.
  Status reach(Solver& solver, std::uint64_t step);
  /// The run ended at `step`, perhaps early: its state is in the last picture, and the outputs are completed.
  Status finish(Solver& solver, std::uint64_t step);
  /// Ends without films, instead of finish(); pictures in directories stay.
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
  Recorder(const PictureOutput& output, const Scene& scene, const Backend& backend,
           const FrameSchedule& schedule);
  Status draw(Solver& solver, std::uint64_t step, std::uint64_t copies);

  PictureOutput output_;
  const Scene& scene_;
  const Backend& backend_;
  FrameSchedule schedule_;
  Following following_;
  std::uint64_t next_frame_ = 0;
  std::optional<std::uint64_t> last_shown_;
  double simulate_seconds_ = 0.0;
  std::shared_ptr<gl::Context> own_context_;
  std::unique_ptr<FilmPainter> film_;
};

}  // namespace aspic
