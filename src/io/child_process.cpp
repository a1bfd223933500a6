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

extern char** environ;

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
  return {ErrorCode::io, fmt::format("{} cannot be started: {}.", program, std::strerror(reason))};
}

/// posix_spawnp with the child's ends of its three streams.
int spawn(const std::vector<std::string>& arguments, int input, int errors, pid_t& pid) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  const int failed = posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments) {
  ChildProcess child;
  // A socket, not a pipe: send() can be told not to raise SIGPIPE, without touching the process's signals.
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return start_error(arguments.front(), errno);
  child.input_ = ends[0];
  child.errors_ = ::memfd_create("messages", MFD_CLOEXEC);
  const int failed = child.errors_ < 0 ? errno : spawn(arguments, ends[1], child.errors_, child.pid_);
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
      errors_(std::exchange(other.errors_, -1)) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
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

ChildProcess::End ChildProcess::finish() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  End end;
  if (pid_ <= 0) return end;
  int status = 0;
  pid_t waited = -1;
  while ((waited = ::waitpid(pid_, &status, 0)) < 0 && errno == EINTR) {
  }
  exchange_running(pid_, 0);
  pid_ = -1;
  if (waited < 0) return end;  // end_child_processes() has waited for it: how it ended is not known
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
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

}  // namespace aspic
