#include "io/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

namespace aspic {
namespace {

// Readable by a signal handler: 0 is a free place.
std::array<std::atomic<pid_t>, 16> running;
static_assert(std::atomic<pid_t>::is_always_lock_free);

void exchange_running(pid_t from, pid_t to) {
  for (std::atomic<pid_t>& place : running) {
    pid_t expected = from;
    if (place.compare_exchange_strong(expected, to)) return;
  }
}

Error start_error(const std::string& program, int reason) {
  return fail(ErrorCode::io, "{} cannot be started: {}.", program, std::strerror(reason));
}

/// Ends of the child's three streams; negative: /dev/null.
struct Streams {
  int input = -1, output = -1, errors = -1;
};

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

/// posix_spawnp, in a process group of its own if `apart`.
int spawn(const std::vector<std::string>& arguments, const Streams& streams, char* const* environment,
          bool apart, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const auto set = [&](int end, int stream, int mode) {
    if (end >= 0)
      posix_spawn_file_actions_adddup2(&actions, end, stream);
    else
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", mode, 0);
  };
  set(streams.input, STDIN_FILENO, O_RDONLY);
  set(streams.output, STDOUT_FILENO, O_WRONLY);
  set(streams.errors, STDERR_FILENO, O_WRONLY);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int flags = POSIX_SPAWN_SETSIGDEF | (apart ? POSIX_SPAWN_SETPGROUP : 0);
  posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  const int failed = posix_spawnp(&pid, arguments.front().c_str(), &actions, &attributes,
                                  pointers(arguments).data(), environment);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

ChildProcess::End wait_for(pid_t pid) {
  int status = 0;
  pid_t waited = -1;
  while ((waited = ::waitpid(pid, &status, 0)) < 0 && errno == EINTR) {
  }
  ChildProcess::End end;
  if (waited < 0) return end;  // end_child_processes() has waited for it: how it ended is not known
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  return end;
}

std::vector<std::string> environment_with(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const bool changed = std::any_of(changes.begin(), changes.end(), [&](const auto& change) {
      return text.starts_with(change.first + "=");
    });
    if (!changed) result.push_back(text);
  }
  for (const auto& [name, value] : changes) result.push_back(fmt::format("{}={}", name, value));
  return result;
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments, Output output) {
  ChildProcess child;
  // A socket, not a pipe: send() can be told not to raise SIGPIPE, without touching the process's signals.
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return start_error(arguments.front(), errno);
  child.input_ = ends[0];
  child.errors_ = ::memfd_create("messages", MFD_CLOEXEC);
  const Streams streams = {ends[1], output == Output::answers ? ends[1] : -1, child.errors_};
  const int failed = child.errors_ < 0 ? errno : spawn(arguments, streams, environ, true, child.pid_);
  ::close(ends[1]);
  if (failed != 0) {
    child.pid_ = -1;
    return start_error(arguments.front(), failed);
  }
  exchange_running(0, child.pid_);
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      input_(std::exchange(other.input_, -1)),
      errors_(std::exchange(other.errors_, -1)),
      answers_(std::move(other.answers_)) {}

ChildProcess::~ChildProcess() {
  kill();
  (void)finish();
  if (errors_ >= 0) ::close(errors_);
}

bool ChildProcess::write(std::span<const std::byte> data) {
  while (!data.empty()) {
    const ssize_t sent = ::send(input_, data.data(), data.size(), MSG_NOSIGNAL);
    if (sent >= 0)
      data = data.subspan(static_cast<std::size_t>(sent));
    else if (errno != EINTR)
      return false;
  }
  return true;
}

std::optional<std::string> ChildProcess::line() {
  std::array<char, 4096> block = {};
  std::size_t end = answers_.find('\n');
  while (end == std::string::npos) {
    const ssize_t got = ::recv(input_, block.data(), block.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return std::nullopt;
    const std::size_t before = answers_.size();
    answers_.append(block.data(), static_cast<std::size_t>(got));
    end = answers_.find('\n', before);
  }
  std::string result = answers_.substr(0, end);
  answers_.erase(0, end + 1);
  return result;
}

void ChildProcess::kill() const {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
}

ChildProcess::End ChildProcess::finish() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (pid_ <= 0) return {};
  const End end = wait_for(pid_);
  exchange_running(std::exchange(pid_, -1), 0);
  return end;
}

void end_child_processes() noexcept {
  for (std::atomic<pid_t>& place : running) {
    const pid_t pid = place.load();
    if (pid <= 0) continue;
    ::kill(pid, SIGKILL);
    (void)::waitpid(pid, nullptr, 0);
  }
}

std::string ChildProcess::last_lines(std::size_t count) const {
  const off_t size = ::lseek(errors_, 0, SEEK_END);
  constexpr off_t most = 16384;
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, most)), '\0');
  const ssize_t got = ::pread(errors_, text.data(), text.size(), std::max<off_t>(size - most, 0));
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (text.empty()) return text;
  std::size_t start = text.size();
  for (; count > 0 && start != 0 && start != std::string::npos; --count) start = text.rfind('\n', start - 1);
  return text.substr(start == std::string::npos || text[start] != '\n' ? 0 : start + 1) + "\n";
}

Result<std::string> output_of(const std::string& program, const std::vector<std::string>& words,
                              const std::vector<std::pair<std::string, std::string>>& environment) {
  std::array<int, 2> ends = {};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return start_error(program, errno);
  std::vector<std::string> arguments = {program};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const std::vector<std::string> variables = environment_with(environment);
  pid_t child = 0;
  const int failed = spawn(arguments, {-1, ends[1], -1}, pointers(variables).data(), false, child);
  ::close(ends[1]);
  std::string output;
  std::array<char, 4096> block = {};
  for (ssize_t got = 0; failed == 0 && ((got = ::read(ends[0], block.data(), block.size())) > 0 ||
                                        (got < 0 && errno == EINTR));)
    if (got > 0) output.append(block.data(), static_cast<std::size_t>(got));
  ::close(ends[0]);
  if (failed != 0) return start_error(program, failed);
  const ChildProcess::End end = wait_for(child);
  if (end.ok()) return output;
  return Error{ErrorCode::check_failed,
               end.signal != 0 ? fmt::format("signal {} ended the child process", end.signal)
                               : fmt::format("the child process ended with exit code {}", end.exit_code)};
}

}  // namespace aspic
