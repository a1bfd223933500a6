#pragma once
// The real program as a child process.
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/temporary_directory.h"

namespace aspic::test {

/// What a finished process left.
struct Finished {
  int exit_code = -1;  ///< −1 if a signal ended it
  int signal = 0;
  std::string out, err;
};

struct ProcessOptions {
  std::vector<std::pair<std::string, std::string>> environment;
  std::string stdout_file;                                ///< empty: captured
  std::optional<std::uint64_t> file_size_limit;           ///< RLIMIT_FSIZE [bytes]
  std::optional<std::uint64_t> address_space_limit = {};  ///< RLIMIT_AS [bytes]
  std::optional<std::uint64_t> stack_limit = {};          ///< RLIMIT_STACK [bytes]
  std::vector<int> closed = {};                           ///< descriptors that are closed when it starts
  bool stdout_to_closed_pipe = false;                     ///< stdout is a pipe that nobody reads
  std::string program = {};                               ///< empty: the aspic that was built
};

/// A running aspic. Killed if it is still there at the end of its life.
class Process {
 public:
  explicit Process(const std::vector<std::string>& arguments, const ProcessOptions& options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Whether it handles that signal by now.
  bool catches(int signal) const;
  /// Waits for its end.
  Finished wait();

 private:
  TemporaryDirectory captured_;
  pid_t pid_ = -1;
};

Finished aspic(const std::vector<std::string>& arguments, const ProcessOptions& options = {});

/// Whether a text is exactly one JSON value with white space around it (RFC 8259).
bool is_json(const std::string& text);

/// The value of the first member of that name as it stands: `"steps": 12,` gives 12, texts without their
/// quotation marks.
std::string json_member(const std::string& text, const std::string& name);

/// The lines of a text.
std::vector<std::string> lines(const std::string& text);

}  // namespace aspic::test
