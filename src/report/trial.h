#pragma once
// One run to its end, and its result: a row of a sweep, a curve of a report.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/course.h"
#include "aspic/scene.h"
#include "aspic/sweep.h"
#include "run/backends.h"
#include "variants/run_length.h"
#include "variants/sweep_figures.h"

namespace aspic::report {

using Outcome = RunOutcome;

struct TrialResult {
  Outcome outcome = Outcome::ok;
  std::string reason;                    ///< one line; empty: ok
  std::uint64_t steps = 0;               ///< the last good one
  std::optional<CourseSummary> summary;  ///< absent: it never began
  std::vector<CourseSample> samples;
  std::vector<State> images;    ///< of `image_times`
  std::string hash;             ///< of the last good state
  std::string solver;           ///< Backend::variant(); empty: it never began
  double seconds = 0.0;         ///< that its steps took, samples not counted
  double thread_seconds = 0.0;  ///< processor time that the calling thread spent on them
};

struct TrialOptions {
  BackendChoice backend;
  RunLength length;
  double interval = sample_interval;         ///< between samples [s]
  std::span<const double> image_times = {};  ///< ascending [s]: states near them are kept
  std::function<bool()> stop = {};           ///< asked at each sample; true ends the run early
};

/// Processor time of the calling thread so far [s]: unlike the clock's it does not count what others do.
double thread_time();

/// Runs a model. A model that a backend rejects, a lost device and a divergence
/// are outcomes. Error (interrupted): `stop` said so.
Result<TrialResult> run_trial(SharedModel model, const TrialOptions& options);

/// A result without figures from an error: rejected for usage and scene_rejected, failed otherwise.
TrialResult trial_error(const Error& error);

}  // namespace aspic::report
