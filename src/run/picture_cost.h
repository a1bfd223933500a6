#pragma once
// The cost of drawing a run, in all and by pass.
#include <functional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/pass_profiler.h"
#include "io/film_format.h"
#include "run/backends.h"

namespace aspic {

/// What is drawn how often.
struct PictureCostOptions {
  PictureSize size;
  double duration = 1.0;  ///< of each repeat, 60 pictures each simulated second [s], > 0
  int repeats = 1;        ///< ≥ 1
  int warm_up = 1;        ///< repeats before them that are not counted, ≥ 0
};

/// Times of single pictures [s], from the state to bytes in memory, with nothing else running.
struct PictureCost {
  std::string device;                     ///< GL_RENDERER
  std::vector<double> seconds;            ///< by the clock
  std::vector<double> processor_seconds;  ///< of all threads of this process
  /// Means over every other picture, which is drawn pass by pass and is none of those above: the state's way
  /// to the device, the renderer's passes (picture_passes.h), the pixels' way back.
  std::vector<gl::PassTime> passes;
};

/// Simulates and draws `duration` seconds of the scene from its start, over and over. `interrupted` is asked
/// between pictures. Errors: those of backend, context and renderer; interrupted; diverged.
Result<PictureCost> measure_pictures(const Scene& scene, const BackendChoice& choice,
                                     const PictureCostOptions& options,
                                     const std::function<bool()>& interrupted);

}  // namespace aspic
