#pragma once
// What `aspic run` says of a run: beforehand, at its end, and where it diverged.
#include <string>
#include <vector>

#include "aspic/run.h"
#include "aspic/scene.h"
#include "base/result.h"
#include "cli/headless_run.h"
#include "cli/json.h"
#include "io/program.h"
#include "model/model.h"
#include "run/backends.h"
#include "run/recording.h"

namespace aspic::cli {

/// A run that has ended, with all that a summary tells of.
struct RunReport {
  const Scene& scene;
  const Model& model;
  const Backend& backend;
  const Outcome& outcome;
  const InputLog& inputs;
};

/// All of it but images and files.
Json to_json(const RunReport& run);
/// The same for people, a line each.
std::string to_text(const RunReport& run);

/// What a watch found, with id, where, step, text and advice of each.
Json to_json(const std::vector<Diagnostic>& diagnostics);
/// The same as exports hold it: docs/exports.md. Empty: nothing.
std::string export_text(const std::vector<Diagnostic>& diagnostics);
/// Images, and the time each took on `device`.
Json to_json(const FrameTimes& times, const std::string& device);
/// One line on stderr: images are by the way, the summary on stdout is the run's.
void print_frame_times(const FrameTimes& times, const std::string& device);

/// `aspic run` with these words, as a shell takes it.
std::string command_of(const std::vector<std::string>& words);

/// Warns where the time step is beyond the estimate of the largest stable one; `of` begins the sentence.
void warn_if_unstable(const Model& model, const InterruptGuard& interrupt, const std::string& of = "");
/// What to say of a run that diverged; `of` begins the sentence: "the simulation".
Error divergence_error(const Model& model, const Outcome& outcome, const InterruptGuard& interrupt,
                       const std::string& of = "the simulation");

}  // namespace aspic::cli
