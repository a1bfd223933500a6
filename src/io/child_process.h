#pragma once
// Other programs: fed through standard input, and those that answer are read from standard output.
#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace aspic {

class Movement;

/// What a program gets besides its words.
struct ChildExtras {
  std::vector<std::pair<std::string, std::string>> environment = {};  ///< variables that differ from ours
  int descriptor = -1;  ///< an open file that it gets too; negative: none
};

/// A program that reads our output, found on PATH, started without a shell. It has a process group of its
/// own, so that Ctrl-C reaches us alone and its input ends in good order. Its standard output goes nowhere
/// unless it answers; its standard error is kept. Once we are asked to end (base/end_request.h), one that no
/// longer moves, neither computing nor reading or writing, is ended after a few seconds.
class ChildProcess {
 public:
  enum class Output { dropped, answers };
  /// The number that ChildExtras::descriptor has there.
  static constexpr int shared_descriptor = 3;
  /// Error (io): `arguments[0]` is not on PATH or cannot be started; the message is the system's alone.
  static Result<ChildProcess> start(const std::vector<std::string>& arguments,
                                    Output output = Output::dropped, const ChildExtras& extras = {});

  /// Closes the input, ends the program if it runs on, and waits for it.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Writes all of it; raises no SIGPIPE. False: the program has stopped reading, or was ended as above.
  bool write(std::span<const std::byte> data);
  /// The next line of a program that answers, without its end; waits for it. Nothing: it has closed its
  /// output, or was ended as above.
  std::optional<std::string> line();
  /// Whether line() would return at once.
  bool answered();

  /// Ends the program at once, from any thread while finish() is not called: line() then returns nothing.
  void kill() const;

  /// How a program ended.
  struct End {
    int exit_code = -1;  ///< −1 if a signal ended it
    int signal = 0;
    bool stalled = false;  ///< it did not end and was ended
    bool unread = false;   ///< it left some of its input unread; not known of one that answers
    bool ok() const { return exit_code == 0 && !unread; }
  };
  /// Closes the input and waits for the end, `most` at most. One that had stopped reading has ten seconds.
  End finish(std::optional<std::chrono::seconds> most = {});

  /// The last lines that it wrote to its standard error, at most `count`, each ended by a newline.
  std::string last_lines(std::size_t count) const;

 private:
  ChildProcess() = default;
  bool wait(short events, Movement& movement);
  bool receive();

  pid_t pid_ = -1;
  int input_ = -1;
  int errors_ = -1;
  Output output_ = Output::dropped;
  bool stalled_ = false, stopped_reading_ = false, closed_ = false;
  std::string answers_;  // read and not yet handed on
};

/// Ends the programs that run at present and waits for them: before their files are removed in a process that
/// is about to end. Safe to call from a signal handler.
void end_child_processes() noexcept;

/// What `program` prints on its standard output with these words and environment variables; its standard
/// error is discarded. Error (io): it cannot be started; check_failed: it ended with another code than 0.
Result<std::string> output_of(const std::string& program, const std::vector<std::string>& words,
                              const std::vector<std::pair<std::string, std::string>>& environment);

}  // namespace aspic
