#pragma once
// A run on its way to its end: what advances it, and what came of it.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aspic/run.h"
#include "aspic/solver.h"
#include "aspic/state.h"
#include "base/result.h"
#include "io/program.h"
#include "run/run_files.h"

namespace aspic::cli {

/// What became of a run.
struct Outcome {
  State state;
  std::uint64_t first_step = 0, last_step = 0;  ///< of this run; last: as planned
  std::optional<Divergence> divergence;
  std::optional<SolveStatistics> solves;  ///< implicit Euler only
  std::optional<double> actuator_work;    ///< over the rows of the series, where there is one [J]
  Status rendered;                        ///< whether the images were completed
  std::vector<Diagnostic> diagnostics;    ///< all that was warned of by a watch
  bool interrupted = false;
  double wall_seconds = 0.0;
  double steps_per_second() const {
    return wall_seconds > 0.0 ? static_cast<double>(state.step - first_step) / wall_seconds : 0.0;
  }
};

/// Says at once what a run has lost and continues without: its user may prefer to end it.
class Losses {
 public:
  /// `failures`: all so far. Prints those that are new.
  void tell(const std::vector<Error>& failures);
  /// A recorder has drawn; `drawn`: how that went. Error: it is lost, and `files` have nothing to write
  /// either. Otherwise rendered() says whether it is still worth calling.
  template <class ImageRecorder>
  Status after_image(ImageRecorder& recorder, const Status& drawn, bool files) {
    std::vector<Error> failures = recorder.failures();
    if (!drawn) {
      if (!files) return drawn;
      recorder.abandon();
      if (failures.empty()) failures.push_back(drawn.error());
      rendered_ = drawn;
    }
    tell(failures);
    return {};
  }
  const Status& rendered() const { return rendered_; }

 private:
  std::size_t told_ = 0;
  Status rendered_;
};

/// The error of a run that lost outputs, none of them if `failures` is empty; `others`: it has completed
/// some.
Status lost_error(const std::vector<Error>& failures, bool others);

/// Steps between polls for Ctrl-C and redraws: as many as take about a twentieth of a second.
class BatchSize {
 public:
  std::uint64_t next() const { return size_; }
  void took(std::uint64_t steps, double seconds);

 private:
  std::uint64_t size_ = 1;
};

/// A solver with the files that take its states. Both must outlive it.
class HeadlessRun {
 public:
  /// The solver is at `first_step`, and has the log's inputs on the way. `others`: the run also writes what
  /// is not among these files, so that it goes on when all of them are lost.
  HeadlessRun(Solver& solver, RunFiles& files, std::uint64_t first_step, bool others, InputLog inputs = {})
      : solver_(solver),
        files_(files),
        others_(others),
        first_step_(first_step),
        step_(first_step),
        inputs_(std::move(inputs)) {}

  /// What the watch finds is warned of, where `of` begins the sentence, and kept for the outcome. The watch
  /// must outlive it.
  void set_watch(RunWatch& watch, std::string of = "") {
    watch_ = &watch;
    watched_ = std::move(of);
    warn(watch.at_start());
  }

  /// Hands the first state to the files.
  Status begin();
  /// Advances to `step` ≥ step(); less far after a divergence, a step() of which is the last good one, and an
  /// interrupt. Calls `did` with the step after each batch. Errors: of the solver and of the files.
  Status advance_to(std::uint64_t step, const InterruptGuard& interrupt,
                    const std::function<void(std::uint64_t)>& did = {});
  std::uint64_t step() const { return step_; }
  const std::optional<Divergence>& divergence() const { return divergence_; }
  bool interrupted() const { return interrupted_; }
  /// It goes no further.
  bool stopped() const { return divergence_ || interrupted_; }
  /// Spent in advance_to() [s].
  double seconds() const { return seconds_; }
  Solver& solver() const { return solver_; }
  const RunFiles& files() const { return files_; }
  const InputLog& inputs() const { return inputs_; }

  /// Where it ended; waits for the device. `wall_seconds` is that of its steps. Error (diverged): a sum over
  /// the state is not a finite number.
  Result<Outcome> outcome(std::uint64_t last_step);

 private:
  Status sample();
  void look(const State& state);
  void warn(std::vector<Diagnostic> found);

  Solver& solver_;
  RunFiles& files_;
  bool others_;
  std::uint64_t first_step_, step_;
  InputLog inputs_;
  std::optional<Divergence> divergence_;
  bool interrupted_ = false;
  double seconds_ = 0.0;
  BatchSize batch_;
  Losses losses_;
  RunWatch* watch_ = nullptr;
  std::string watched_;
  State state_;  // the latest that was looked at
  std::vector<Diagnostic> found_;
};

}  // namespace aspic::cli
