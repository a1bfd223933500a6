#pragma once
// Pictures of a run while it runs.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "command_line/arguments.h"
#include "run/backends.h"
#include "gpu/pixel_ring.h"
#include "io/frame_schedule.h"
#include "io/frame_sink.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace aspic {

/// --fps, or what the outputs take where it is absent.
double frames_per_second(const RecordingOptions& options);

/// Time the program spent in each stage of its pictures [s], in all. A device works on while the program
/// does: its time shows where it is waited for.
struct FrameTimes {
  std::uint64_t frames = 0;
  double simulate = 0.0, draw = 0.0, read = 0.0, encode = 0.0;
  double per_frame(double total) const { return frames > 0 ? total / static_cast<double>(frames) : 0.0; }
};

class Recorder {
 public:
  /// Draws in the backend's context where it has one, else in a headless one of its own. Everything given
  /// must outlive the recorder. Errors: no_device, scene_rejected (no device memory), io (a shader file).
  static Result<std::unique_ptr<Recorder>> create(const RecordingOptions& options, const Scene& scene,
                                                  const Model& model, const Backend& backend,
                                                  std::vector<FrameSink*> sinks, std::uint64_t first_step,
                                                  std::uint64_t last_step);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The step that the next picture shows; after the last one, a step that no run reaches.
  std::uint64_t next_step() const;
  /// The solver stands at `step` ≤ next_step(): draws every picture that shows it.
  Status reach(Solver& solver, std::uint64_t step);
  /// The run ended at `step`, perhaps early: its state is in the last picture, and all pictures are handed
  /// on. The sinks are not finished.
  Status finish(Solver& solver, std::uint64_t step);

  void add_simulation(double seconds) { times_.simulate += seconds; }
  const FrameTimes& times() const { return times_; }
  /// GL_RENDERER of what draws.
  const std::string& device() const;

 private:
  Recorder(const RecordingOptions& options, const Scene& scene, const Model& model,
           std::vector<FrameSink*> sinks, const FrameSchedule& schedule);
  Status draw(Solver& solver, std::uint64_t step);
  Status hand_on();

  RecordingOptions options_;
  const Scene& scene_;
  const Model& model_;
  std::vector<FrameSink*> sinks_;
  FrameSchedule schedule_;
  std::uint64_t next_frame_ = 0, last_shown_ = 0;
  std::unique_ptr<gl::Context> own_context_;
  gl::Context* context_ = nullptr;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<gl::PixelRing> ring_;
  std::vector<std::byte> pixels_;
  FrameTimes times_;
};

}  // namespace aspic
