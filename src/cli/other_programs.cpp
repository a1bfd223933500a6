// Commands that are separate programs: the window, so that aspic starts on machines without X libraries, and
// studies, so that a video does not wait for them to compile.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/commands.h"

namespace aspic::cli {
namespace {

/// Why a program could not be started.
struct NotStarted {
  std::string program;
  int reason = 0;  ///< errno
};

/// Becomes a program installed next to this one. Returns only if that fails.
NotStarted become(const char* name, const std::vector<std::string>& arguments) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = (self.parent_path() / name).string();
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  return {program, errno};
}

}  // namespace

Status execute(const ViewOptions& options) {
  const NotStarted error = become("aspic-view", options.words);
  if (error.reason == ENOENT)
    return fail(ErrorCode::no_device,
                "Cannot find {}: this aspic was built without the window. Install libglfw3-dev and "
                "libimgui-dev and build again; aspic run SCENE --video FILE.mp4 needs no window.",
                error.program);
  return fail(
      ErrorCode::no_device,
      "Cannot start {}: {}. Its libraries may be missing; aspic run SCENE --video FILE.mp4 needs no window.",
      error.program, std::strerror(error.reason));
}

Status execute_study(const std::vector<std::string>& arguments) {
  const NotStarted error = become("aspic-studies", arguments);
  return fail(ErrorCode::io,
              "Cannot start {}: {}. It has the commands bench, report, sweep and verify. Run scripts/run.sh "
              "info in the checkout to build it, or install Aspic again.",
              error.program, std::strerror(error.reason));
}

}  // namespace aspic::cli
