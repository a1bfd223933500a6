#pragma once
// The output files of a run: opened before it, closed whole after it.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "command_line/arguments.h"
#include "io/atomic_file.h"
#include "io/frame_sink.h"
#include "io/series_csv.h"

namespace aspic {

class RunFiles {
 public:
  /// Opens every file the options name. Errors: usage for one name given twice; io.
  static Result<RunFiles> open(const RunOptions& options, Integrator integrator);

  /// Steps between rows of the series; 0 without one.
  std::uint64_t series_interval() const { return series_ ? every_ : 0; }
  /// Where pictures go; empty without any.
  std::vector<FrameSink*> frame_sinks() const;
  /// Adds a row of the series, if there is one.
  Status add_row(const Model& model, const State& state, const SolveStatistics& solves);

  /// Writes final state and checkpoint and completes all files. One that fails does not keep the others from
  /// being completed; the first error is returned.
  Status finish(const Model& model, const std::string& scene_toml, const State& state);

  /// Names of the completed files.
  const std::vector<std::string>& written() const { return written_; }

 private:
  RunFiles() = default;
  std::uint64_t every_ = 1;
  std::optional<AtomicFile> state_, checkpoint_;
  std::optional<SeriesWriter> series_;
  std::unique_ptr<FrameSink> video_, frames_;
  std::string series_path_;
  std::vector<std::string> written_;
};

}  // namespace aspic
