#pragma once
// The grid of runs that --vary describes.
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "aspic/sweep.h"
#include "run/backends.h"
#include "variants/run_length.h"

namespace aspic::report {

/// A key and its values, in their order.
struct Axis {
  std::string key;                  ///< a short name (scene/short_keys.h), a path of --set, or "backend"
  std::vector<std::string> values;  ///< at least one
};

/// KEY=from:to:count, the same with :log, or KEY=a,b,c. Commas within brackets or quotation marks separate no
/// values; values of whole-number keys are rounded, and equal ones appear once. Error (usage).
Result<Axis> parse_axis(const std::string& text, const Scene& scene);

/// Evenly spaced numbers, both ends included; with `log`, in constant ratios. `count` ≥ 1; one is `from`.
std::vector<double> spaced(double from, double to, std::size_t count, bool log);

/// Most runs of a grid.
inline constexpr std::size_t most_runs = 1000000;

struct Grid {
  Scene scene;
  BackendChoice backend;  ///< of runs that vary none
  RunLength length;
  std::vector<Axis> axes;  ///< the last one varies fastest

  std::size_t size() const;
  /// The value of each axis in run `index` < size().
  std::vector<std::string> values(std::size_t index) const;
  /// 16 hexadecimal digits: of the version, the scene, the axes, the length and the backend's options.
  std::string identity() const;
};

/// Reads axes and refuses, before any run: more than most_runs; a key that is given twice; a key that the
/// scene rejects at every value (usage, scene_rejected).
Result<Grid> make_grid(Scene scene, const BackendChoice& backend, const RunLength& length,
                       const std::vector<std::string>& vary);

/// What a run of the grid simulates, and with what.
SweepRun grid_run(const Grid& grid, std::size_t index);

}  // namespace aspic::report
