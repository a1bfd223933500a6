#pragma once
// What the program says: data to stdout, everything else to stderr.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace aspic {

/// Whoever read stdout, or a file such as /dev/stdout that is stdout, has ended, as head does when it has its
/// lines. Nothing is said then, and the exit code is the one a shell gives to programs that the signal
/// SIGPIPE ends.
inline constexpr auto closed_pipe = ErrorCode{141};

/// Writes data to stdout and flushes. Errors: io, a full disk behind a redirection; closed_pipe, without a
/// message.
Status print_data(std::string_view text);

/// Writes text for people to stdout as print_data does, escaped as the messages below.
Status print_text(std::string_view text);

// Messages may quote names, options, scenes and drivers: all of them pass through printable()
// (base/printable.h), so that nothing from outside acts on the terminal.

/// A line on stderr: "aspic: <text>".
void print_message(std::string_view text);
/// "aspic: warning: <text>".
void print_warning(std::string_view text);

/// A bar on stderr where that is a terminal, nothing elsewhere. Removed when it goes out of scope.
class ProgressBar {
 public:
  /// `unit`: what is counted, in the singular.
  explicit ProgressBar(std::uint64_t total, std::string_view unit = "step");
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Redraws at most ten times a second.
  void update(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  bool visible_;
  bool drawn_ = false;
  std::uint64_t total_;
  std::string unit_;
  Clock::time_point start_ = Clock::now(), last_ = {};
};

/// Where stderr is no terminal: a line at every tenth of a long piece of work, with an estimate of what is
/// left.
class ProgressLines {
 public:
  /// `unit`: what is counted, in the plural.
  ProgressLines(std::uint64_t total, std::string_view unit);
  /// A part that may take a while begins.
  void begin(std::string_view name) const;
  void update(std::uint64_t done);

 private:
  bool silent_;
  std::uint64_t total_, tenth_ = 0;
  std::string unit_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace aspic
