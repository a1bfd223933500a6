#pragma once
// What both programs do around their work, so that nothing from outside ends them without a sentence.
#include <functional>

namespace aspic {

/// Runs `work` and returns its exit code, or 6 if it ends with an exception: a sentence goes to stderr and
/// the temporary files of this process are removed. Before that it
/// - opens /dev/null on those of the descriptors 0, 1 and 2 that are closed, so that no file that is opened
///   later takes their place and receives messages;
/// - ignores SIGPIPE and SIGXFSZ: closed pipes and the limit on file sizes (ulimit -f) make write() fail;
/// - sees to it that a fatal signal, such as one raised inside a graphics driver, removes the temporary files
///   and says a sentence before it ends the process as it would have.
/// Call it once, first of all in main().
int run_program(const std::function<int()>& work);

/// While one lives, SIGINT, SIGTERM and SIGHUP only set end_requested (base/end_request.h). A second SIGINT
/// or SIGTERM removes temporary files and ends the process at once, as the signal would have; SIGHUP never
/// does, since a terminal that closes may send several. A SIGHUP that is ignored, as under nohup, stays so.
/// At most one may live at a time; the old handlers return with its end.
class InterruptGuard {
 public:
  /// The signal at which the program ends at once: a process whose results nobody waits for has nothing to
  /// complete after the first.
  enum class At { first_signal, second_signal };
  explicit InterruptGuard(At at_once = At::second_signal);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether the program has been asked to end since the guard was made.
  bool interrupted() const;
};

}  // namespace aspic
