#pragma once
// The command line as plain data.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aspic/scene.h"
#include "aspic/state.h"
#include "base/result.h"
#include "run/backends.h"
#include "run/run_files.h"
#include "variants/run_length.h"

namespace aspic {

/// How scenes are read with the arguments of an option.
inline const LoadOptions by_set = {.origin = "--set"}, by_view = {.origin = "--view"};

struct RunOptions {
  std::string scene;  ///< empty: that of the checkpoint
  std::vector<std::string> overrides;
  BackendChoice backend;
  bool precision_given = false;
  RunLength length;
  std::string resume_file;           ///< empty: none
  std::string replay_file;           ///< of inputs; empty: none
  std::vector<StateOutput> outputs;  ///< one for each of state_options()
  ImageOutput images;
  std::vector<std::string> view;         ///< KEY=VALUE of the scene's view table, for the images
  std::vector<std::string> differences;  ///< KEY=VALUE, one for each further run
  bool force = false;
  bool json = false;
  std::vector<std::string> words;  ///< the arguments after `run` as they were given
};

struct CompareOptions {
  std::string scene;
  std::vector<std::string> overrides;
  BackendChoice first, second;
  RunLength length;
  std::string replay_file;  ///< of inputs; empty: none
  double tolerance = 0.0;   ///< [m] and [m/s], ≥ 0; 0: every bit the same
  bool json = false;
};

enum class BenchTimestep {
  scene,   ///< the scene's own
  largest  ///< 0.99 of the largest stable one; a sixtieth of a second with implicit-euler
};

struct BenchOptions {
  std::string scene = "cube-plane";
  std::vector<std::string> overrides;
  std::vector<BackendChoice> backends;  ///< at least one
  std::vector<int> sizes;               ///< particles per edge of all cubes; empty: the scene's
  std::vector<Integrator> integrators;  ///< empty: the scene's
  BenchTimestep timestep = BenchTimestep::scene;
  double seconds = 2.0;             ///< per measurement, all repeats together, > 0
  std::optional<double> duration;   ///< simulated time of each repeat [s], instead of `seconds`
  int repeats = 5;                  ///< ≥ 1
  int warm_up = 1;                  ///< runs of each case before them, ≥ 0
  std::optional<ImageSize> images;  ///< what an image of this size costs is measured instead
  bool json = false;
};

struct SweepOptions {
  std::string scene;
  std::vector<std::string> overrides;
  BackendChoice backend;
  RunLength length;
  std::vector<std::string> vary;      ///< KEY=VALUES, at least one
  std::string out;                    ///< the CSV file; empty: none
  std::string runs;                   ///< the folder that keeps each run; empty: none, and there is `out`
  unsigned jobs = 0;                  ///< processes; 0: as many as are worthwhile
  std::uint64_t part = 1, parts = 1;  ///< 1 ≤ part ≤ parts
  bool force = false;
  bool json = false;
  bool worker = false;             ///< it serves another sweep's process
  std::vector<std::string> words;  ///< the arguments after `sweep` as they were given
};

struct ReportOptions {
  std::string scene = "cube-plane";
  std::vector<std::string> overrides;
  std::string out;                ///< directory
  std::vector<std::string> only;  ///< names of sections; empty: all
  std::string outline;            ///< of a course; empty: the report's own order
  bool thorough = false;
  bool force = false;
  unsigned jobs = 0;  ///< threads; 0: as many as there are processors
  bool json = false;
};

struct VerifyOptions {
  bool quick = false;
  std::vector<std::string> only;  ///< names of checks or groups; empty: all
  bool require_gpu = false;       ///< rows that found no device fail
  bool list = false;              ///< the names alone; nothing is checked
  bool json = false;
};

struct ViewOptions {
  std::string scene = "cube-plane";
  std::vector<std::string> overrides;
  BackendChoice backend;
  std::optional<ImageSize>
      size;                 ///< of the window, in the display's units; absent: as it was last, or 1280 × 720
  std::string layout;       ///< one of window_layouts; empty: as it was last
  std::string replay_file;  ///< of inputs; empty: none
  std::vector<std::string> words;  ///< the arguments after `view` as they were given
};

struct SceneListOptions {
  bool json = false;
};
struct SceneShowOptions {
  std::string scene;
  std::vector<std::string> overrides;
};
struct SceneCheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool json = false;
};
struct SceneImportOptions {
  std::string file;              ///< a mesh, or Configuration.txt of the 2018 framework
  std::optional<int> cells;      ///< the next four are for meshes: along the longest edge
  std::optional<double> height;  ///< [m]
  std::optional<std::string> up, pieces;
};
struct InfoOptions {
  bool json = false;
};
/// --help, --version: text for stdout and nothing else to do.
struct ShowText {
  std::string text;
};

using Command = std::variant<ShowText, RunOptions, ViewOptions, CompareOptions, BenchOptions, SweepOptions,
                             ReportOptions, VerifyOptions, SceneListOptions, SceneShowOptions,
                             SceneCheckOptions, SceneImportOptions, InfoOptions>;

/// Errors: usage, with a suggestion for a misspelt command or option; scene_rejected for what is not built
/// yet.
Result<Command> parse_arguments(int argc, const char* const* argv);

}  // namespace aspic
