#pragma once
// The files of a run: opened before it, completed after it.
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "io/film_format.h"
#include "run/outputs.h"

namespace aspic {

class RunFiles {
 public:
  /// Opens every file that is named. Errors: usage for one name given twice; io.
  static Result<RunFiles> open(const std::vector<StateOutput>& states, const PictureOutput& pictures,
                               const RunFacts& facts, Overwrite overwrite);

  /// The first step after `step` at which a file wants the state; the largest number if none does.
  std::uint64_t next_step(std::uint64_t step) const;
  /// Hands a state to the files that want it: the first of the run, and those of next_step().
  Status take(const Sample& sample);
  /// Completes all files with the last state. One that fails does not keep the others from being completed;
  /// the first error is returned.
  Status finish(const Sample& last);

  /// Hands over the sinks of the pictures.
  std::vector<std::unique_ptr<FrameSink>> take_frame_sinks() { return std::move(frame_sinks_); }
  /// Names of the completed files.
  const std::vector<std::string>& written() const { return written_; }

 private:
  RunFiles() = default;
  std::vector<std::unique_ptr<StateSink>> sinks_;
  std::vector<std::unique_ptr<FrameSink>> frame_sinks_;
  std::vector<std::string> written_;
  bool begun_ = false;
};

}  // namespace aspic
