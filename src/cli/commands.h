#pragma once
// The commands. Each prints its data to stdout and returns success or the error whose code is the exit code.
#include <string>
#include <vector>

#include "base/result.h"
#include "command_line/arguments.h"
#include "io/console.h"

namespace aspic::cli {

inline Status execute(const ShowText& shown) {
  return print_data(shown.text);
}

/// Simulates; writes the files asked for. Errors in addition to those of its parts: diverged and interrupted,
/// both after the files are complete.
Status execute(const RunOptions& options);
/// The same for options with --variant.
Status execute_comparison(const RunOptions& options);

/// Becomes the window program, aspic-view, installed next to this one. Error (no_device): it is not there.
Status execute(const ViewOptions& options);
/// Becomes aspic-studies, installed next to this one, with these arguments. Error (io): it is not there.
Status execute_study(const std::vector<std::string>& arguments);

/// Steps two backends side by side. Error (check_failed): they differ by more than the tolerance.
Status execute(const CompareOptions& options);

/// Measures throughput, one line for each size, integrator, backend and force path.
Status execute(const BenchOptions& options);

/// Runs a grid of runs and writes a row for each. Errors: those of run_sweep().
Status execute(const SweepOptions& options);

/// Compares a scene's integrators and parameters, as pages with plots. Errors: those of write_report().
Status execute(const ReportOptions& options);

/// Runs the verification battery and prints its table. Errors: usage, an unknown name; check_failed.
Status execute(const VerifyOptions& options);

Status execute(const SceneListOptions& options);
Status execute(const SceneShowOptions& options);
Status execute(const SceneCheckOptions& options);
/// The scene goes to stdout; settings that it cannot carry are listed there in comments and on stderr.
Status execute(const SceneImportOptions& options);

/// Never fails for want of a GPU: says so instead.
Status execute(const InfoOptions& options);

/// Prints what may stand in place of the last of a command line's words, of which the first is the program: a
/// word, a tabulator and its help in each line, or :file, :directory or :toml for names of files.
void complete(std::vector<std::string> words);

}  // namespace aspic::cli
