#pragma once
// From the words the command line parser read to the values the commands take.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/arguments.h"

namespace aspic {

/// What the parser fills in before words become values.
struct RawOptions {
  std::string backend = "auto", precision, force_path = "auto", arithmetic = "exact";
  std::optional<unsigned> threads;
  std::vector<std::string> backends = {"gpu", "reference"};
  std::vector<std::string> bench_backends = {"auto"}, bench_force_paths, bench_integrators;
  std::string bench_timestep = "scene", bench_images;
  std::string part = "1/1";
  std::string window_size, size = "1280x720", frames_format = "png", text = "on";
  bool no_text = false;
  std::vector<std::string> given;  ///< every option, as it was typed: "--every"

  bool gave(std::string_view option) const { return std::ranges::find(given, option) != given.end(); }
};

/// An Error of the command line.
template <class... T>
Error usage(fmt::format_string<T...> message, T&&... arguments) {
  return fail(ErrorCode::usage, message, std::forward<T>(arguments)...);
}

// Each completes the options of one command. Errors: usage, with what is allowed; scene_rejected for what is
// not built yet.
Result<Command> finish_run(RunOptions run, const RawOptions& raw);
Result<Command> finish_compare(CompareOptions compare, const RawOptions& raw);
Result<Command> finish_view(ViewOptions view, const RawOptions& raw);
Result<Command> finish_sweep(SweepOptions sweep, const RawOptions& raw);
Result<Command> finish_bench(BenchOptions bench, const RawOptions& raw);
Result<Command> finish_import(const SceneImportOptions& import);

}  // namespace aspic
