#pragma once
// The cost of rendering a run, in all and by pass.
#include <functional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/pass_profiler.h"
#include "io/video_format.h"
#include "run/backends.h"

namespace aspic::cli {

/// Images to render, and repeats.
struct FrameCostOptions {
  ImageSize size;
  double duration = 1.0;  ///< of each repeat, 60 frames each simulated second [s], > 0
  int repeats = 1;        ///< ≥ 1
  int warm_up = 1;        ///< repeats before them that are not counted, ≥ 0
};

/// Times of single frames [s], from the state to bytes in memory, with nothing else running.
struct FrameCost {
  std::string device;               ///< GL_RENDERER
  std::vector<double> seconds;      ///< wall-clock time
  std::vector<double> cpu_seconds;  ///< CPU time of all threads of this process
  /// Means over every second frame, which is rendered pass by pass and not counted above: upload of the
  /// state, the renderer's passes (frame_passes.h), read-back of the pixels.
  std::vector<gl::PassTime> passes;
};

/// Simulates and renders `duration` seconds of the scene from its start, once per repeat. Calls `interrupted`
/// between frames. Errors: those of backend, context and renderer; interrupted; diverged.
Result<FrameCost> measure_frames(const Scene& scene, const BackendChoice& choice,
                                 const FrameCostOptions& options, const std::function<bool()>& interrupted);

}  // namespace aspic::cli
