#pragma once
// Finished runs in a folder, a file each, which aspic.sweep() of Python reads and writes too
// (docs/sweeps.md).
#include <optional>
#include <string>

#include "aspic/scene.h"
#include "aspic/sweep.h"
#include "base/result.h"
#include "report/sweep_rows.h"

namespace aspic::report {

class RunFolder {
 public:
  /// The folder, made where there is none, with the scene that the runs differ from in it. Error (io).
  static Result<RunFolder> open(std::string path, const Scene& scene);

  /// A run that is there. Nothing where there is none, where its file is damaged or no regular file, and
  /// where it failed: then it may succeed. Error (io): a directory is in its place, which write() keeps.
  Result<std::optional<RunRow>> read(const SweepRun& run) const;
  /// Keeps a run; one that is there is replaced. Error (io).
  Status write(const SweepRun& run, const RunRow& row) const;

 private:
  RunFolder(std::string path, std::string scene) : path_(std::move(path)), scene_(std::move(scene)) {}
  std::string file_of(const SweepRun& run) const { return path_ + "/runs/" + run.key + ".json"; }

  std::string path_, scene_;
};

}  // namespace aspic::report
