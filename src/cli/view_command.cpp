#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/commands.h"

namespace aspic::cli {

// The window is a separate program, so that this one starts on machines without X libraries.
Status execute(const ViewOptions& options) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = (self.parent_path() / "aspic-view").string();
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& word : options.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  const int reason = errno;
  if (reason == ENOENT)
    return fail(ErrorCode::no_device,
                "There is no {}: this aspic was built without the window. Install libglfw3-dev and "
                "libimgui-dev and build again; aspic run SCENE --video FILE.mp4 needs no window.",
                program);
  return fail(ErrorCode::no_device,
              "{} cannot be started: {}. Its libraries may be missing; aspic run SCENE --video FILE.mp4 "
              "needs no window.",
              program, std::strerror(reason));
}

}  // namespace aspic::cli
