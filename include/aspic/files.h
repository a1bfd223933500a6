#pragma once
// Files: states, checkpoints, and outputs of frames. Formats: docs/files.md.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/inputs.h"
#include "aspic/model.h"
#include "aspic/settings.h"
#include "aspic/solver.h"
#include "aspic/state.h"

namespace aspic {

/// What to do where a file is there already. Files appear complete or not at all.
enum class Overwrite { refuse, allow };

/// Writes a state of the model as its path ends: .csv or .vtp. Errors: usage, it ends otherwise; diverged, a
/// number is not finite; io.
ASPIC_API Status write_state(const std::string& path, const Model& model, const State& state,
                             Overwrite overwrite);

/// A suspended run: the complete scene and the state at full precision in one file.
struct Checkpoint {
  std::string program_version;  ///< of the program that wrote it: printable ASCII, at most 64 characters
  std::string scene;            ///< the complete scene as TOML, as to_toml() writes it
  double timestep = 0.0;        ///< h [s], the scene's own: repeated to be seen without parsing
  State state;                  ///< with its precision and step
  std::string inputs = {};      ///< the run's input log as TOML, of later steps too; empty: none
};

/// Reads a file. Errors (io): it cannot be read, is no regular file (a device or pipe may never end), no
/// checkpoint, of another format version, damaged or cut short, or larger than free memory. Nothing is
/// allocated for sizes that the file names before they are found to fit the file.
ASPIC_API Result<Checkpoint> read_checkpoint(const std::string& path);
/// Writes one of this version of the library. Errors: diverged, a number of the state is not finite; io.
ASPIC_API Status write_checkpoint(const std::string& path, const std::string& scene_toml, const Model& model,
                                  const State& state, Overwrite overwrite);

/// What is known of a run before it starts.
struct RunFacts {
  std::string scene_toml;                              ///< the complete scene, as a checkpoint keeps it
  Integrator integrator = Integrator::explicit_euler;  ///< of the run's model
  std::string inputs_toml = {};                        ///< the run's input log; empty: none
};

/// A state of a run, with its model.
struct Sample {
  const Model& model;               ///< what the state is of
  const State& state;               ///< has its numbers of particles and balls
  SolveStatistics solves = {};      ///< of the run so far; zeros unless the integrator is implicit-euler
  const RunFacts* facts = nullptr;  ///< null except within a sink that was told them
  const Divergence* divergence = nullptr;  ///< of the step after it, which ended the run; null: none
  const Inputs* inputs = nullptr;  ///< those of the step after it (Solver::inputs()); null: there are none
  std::string_view warnings = {};  ///< of the run so far, as the JSON of docs/exports.md; empty: none
};

/// Width and height of a frame or image [pixels].
struct ImageSize {
  int width = 1280;  ///< ≥ 1
  int height = 720;  ///< ≥ 1
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

struct VideoFormat;  // of the library's table
/// The format of images or videos with that name or ending, in any case: "png", "jpg", "mp4", …; null if
/// there is none.
ASPIC_API const VideoFormat* find_video_format(std::string_view word);

/// Takes the frames of a run in order. One that is destroyed before finish() leaves nothing that looks
/// complete. A Recorder calls write() and finish() on its own encoding thread, one at a time.
class ASPIC_API FrameSink {
 public:
  virtual ~FrameSink();
  /// height·width·3 bytes RGB, sRGB encoded, rows from the top down. Error (io): it cannot be written; the
  /// sink takes no more.
  virtual Status write(std::span<const std::byte> rgb) = 0;
  /// Completes the output. Error (io).
  virtual Status finish() = 0;
  /// What was written, for reports.
  virtual const std::string& path() const = 0;
};

}  // namespace aspic
