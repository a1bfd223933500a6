#include "io/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
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
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "base/end_request.h"

namespace aspic {

/// Whether a group of processes moves, once the program is asked to end.
class Movement {
 public:
  explicit Movement(pid_t group) : group_(group) {}

  /// It has taken or given something.
  void seen() {
    idle_.renew();
    busy_.renew();
  }
  /// It is worth waiting for no longer. To be asked ten times a second.
  bool over() {
    if (!end_requested) return false;
    const Work work = work_of(group_);
    if (work.bytes != last_.bytes)
      seen();
    else if (work.ticks != last_.ticks)
      idle_.renew();
    last_ = work;
    return idle_.over() || busy_.over();
  }

 private:
  /// What a group of processes has done so far.
  struct Work {
    std::uint64_t ticks = 0;  // of processors
    std::uint64_t bytes = 0;  // read and written
  };
  static Work work_of(pid_t group);

  pid_t group_;
  Work last_;
  Patience idle_{std::chrono::seconds(4)};   // of one that does nothing
  Patience busy_{std::chrono::seconds(30)};  // of one that computes, but neither reads nor writes
};

// proc(5): the fields of /proc/PID/stat behind the name, which may hold spaces and brackets.
Movement::Work Movement::work_of(pid_t group) {
  Work work;
  std::error_code failed;
  for (std::filesystem::directory_iterator it("/proc", failed), end; !failed && it != end;
       it.increment(failed)) {
    const std::string name = it->path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream stat(it->path() / "stat");
    std::string line, state;
    std::getline(stat, line);
    const std::size_t bracket = line.rfind(')');
    if (bracket == std::string::npos) continue;
    std::istringstream fields(line.substr(bracket + 1));
    std::int64_t parent = 0, of_group = 0, skipped = 0;
    std::uint64_t user = 0, system = 0;
    fields >> state >> parent >> of_group;
    if (of_group != group) continue;
    for (int field = 6; field <= 13; ++field) fields >> skipped;
    fields >> user >> system;
    work.ticks += user + system;
    std::ifstream io(it->path() / "io");
    std::string key;
    for (std::uint64_t value = 0; io >> key >> value;)
      if (key == "rchar:" || key == "wchar:") work.bytes += value;
  }
  return work;
}

namespace {

// Readable by a signal handler: 0 is a free place.
std::array<std::atomic<pid_t>, 64> running;
static_assert(std::atomic<pid_t>::is_always_lock_free);

void exchange_running(pid_t from, pid_t to) {
  for (std::atomic<pid_t>& place : running) {
    pid_t expected = from;
    if (place.compare_exchange_strong(expected, to)) return;
  }
}

Error start_error(const std::string& program, int reason) {
  return fail(ErrorCode::io, "Cannot start {}: {}.", program, std::strerror(reason));
}

/// Ends of the child's three streams; negative: /dev/null. `shared`: its shared_descriptor; negative: none.
struct Streams {
  int input = -1, output = -1, errors = -1, shared = -1;
};

std::vector<char*> pointers(const std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (const std::string& text : texts) result.push_back(const_cast<char*>(text.c_str()));
  result.push_back(nullptr);
  return result;
}

/// posix_spawnp, in a separate process group if `apart`.
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
  // Last: what is copied above may have this number here.
  if (streams.shared >= 0)
    posix_spawn_file_actions_adddup2(&actions, streams.shared, ChildProcess::shared_descriptor);
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

/// To all of a group; to the first process alone where that is all there is.
void signal_group(pid_t pid, int number) {
  if (::kill(-pid, number) != 0) ::kill(pid, number);
}

/// Ends all of a group. Its first process, which may have temporary files to remove, is asked to end and has
/// half a second for it; its end is left for waitpid(). Safe to call from a signal handler.
void end_group(pid_t pid) {
  signal_group(pid, SIGTERM);
  constexpr timespec nap = {0, 5'000'000};
  siginfo_t ended = {};
  for (int n = 0; n < 100; ++n) {
    if (::waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0) break;
    if (ended.si_pid == pid) break;
    ::nanosleep(&nap, nullptr);
  }
  signal_group(pid, SIGKILL);
}

/// Ends it where `over` says so, which is asked ten times a second.
template <class Over>
ChildProcess::End wait_for(pid_t pid, const Over& over) {
  using namespace std::chrono_literals;
  ChildProcess::End end;
  int status = 0;
  pid_t waited = -1;
  auto nap = 1ms, slept = 0ms;
  while ((waited = ::waitpid(pid, &status, WNOHANG)) == 0 || (waited < 0 && errno == EINTR)) {
    std::this_thread::sleep_for(nap);
    slept += nap;
    nap = std::min(2 * nap, 16ms);
    if (slept < 100ms || end.stalled) continue;
    slept = 0ms;
    if (!over()) continue;
    end.stalled = true;
    signal_group(pid, SIGKILL);
  }
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

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& arguments, Output output,
                                         const ChildExtras& extras) {
  ChildProcess child;
  // A socket, not a pipe: send() can be told not to raise SIGPIPE, without touching the process's signals.
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return start_error(arguments.front(), errno);
  child.input_ = ends[0];
  child.output_ = output;
  child.errors_ = ::memfd_create("messages", MFD_CLOEXEC);
  const Streams streams = {ends[1], output == Output::answers ? ends[1] : -1, child.errors_,
                           extras.descriptor};
  const std::vector<std::string> variables = environment_with(extras.environment);
  const int failed =
      child.errors_ < 0 ? errno : spawn(arguments, streams, pointers(variables).data(), true, child.pid_);
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
      output_(other.output_),
      stalled_(other.stalled_),
      stopped_reading_(other.stopped_reading_),
      closed_(other.closed_),
      answers_(std::move(other.answers_)) {}

ChildProcess::~ChildProcess() {
  kill();
  (void)finish();
  if (errors_ >= 0) ::close(errors_);
}

/// Until the socket is ready; false if the program was ended, since it does not move.
bool ChildProcess::wait(short events, Movement& movement) {
  pollfd socket = {input_, events, 0};
  (void)::poll(&socket, 1, 100);
  if (socket.revents != 0 || !movement.over()) return true;
  stalled_ = true;
  kill();
  return false;
}

bool ChildProcess::write(std::span<const std::byte> data) {
  Movement movement(pid_);
  while (!data.empty()) {
    const ssize_t sent = ::send(input_, data.data(), data.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      data = data.subspan(static_cast<std::size_t>(sent));
      movement.seen();
    } else if (errno == EAGAIN) {
      if (!wait(POLLOUT, movement)) return false;
    } else if (errno != EINTR) {
      stopped_reading_ = true;
      return false;
    }
  }
  return true;
}

/// Takes what has been answered so far. False: nothing was there.
bool ChildProcess::receive() {
  std::array<char, 4096> block = {};
  for (;;) {
    const ssize_t got = ::recv(input_, block.data(), block.size(), MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) return false;
    closed_ = got <= 0;
    if (!closed_) answers_.append(block.data(), static_cast<std::size_t>(got));
    return true;
  }
}

bool ChildProcess::answered() {
  while (answers_.find('\n') == std::string::npos && !closed_)
    if (!receive()) return false;
  return true;
}

std::optional<std::string> ChildProcess::line() {
  Movement movement(pid_);
  while (!answered())
    if (!wait(POLLIN, movement)) return std::nullopt;
  const std::size_t end = answers_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string result = answers_.substr(0, end);
  answers_.erase(0, end + 1);
  return result;
}

void ChildProcess::kill() const {
  if (pid_ > 0) end_group(pid_);
}

ChildProcess::End ChildProcess::finish(std::optional<std::chrono::seconds> most) {
  if (pid_ <= 0) {
    if (input_ >= 0) ::close(std::exchange(input_, -1));
    return {};
  }
  // A socket that stays open for reading tells whether its other end was closed with something unread. One
  // that answers would wait for us to read the rest.
  const bool listens = output_ == Output::dropped;
  if (listens)
    ::shutdown(input_, SHUT_WR);
  else
    ::close(std::exchange(input_, -1));
  if (stopped_reading_ && !most) most = std::chrono::seconds(10);
  const auto started = std::chrono::steady_clock::now();
  Movement movement(pid_);
  End end = wait_for(
      pid_, [&] { return movement.over() || (most && std::chrono::steady_clock::now() - started > *most); });
  exchange_running(std::exchange(pid_, -1), 0);
  end.stalled = end.stalled || stalled_;
  if (!listens) return end;
  int error = 0;
  socklen_t size = sizeof error;
  end.unread = stopped_reading_ ||
               (::getsockopt(input_, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == ECONNRESET);
  ::close(std::exchange(input_, -1));
  return end;
}

void end_child_processes() noexcept {
  for (std::atomic<pid_t>& place : running) {
    const pid_t pid = place.load();
    if (pid <= 0) continue;
    end_group(pid);
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
  const ChildProcess::End end = wait_for(child, [] { return false; });
  if (end.ok()) return output;
  return Error{ErrorCode::check_failed,
               end.signal != 0 ? fmt::format("signal {} ended the child process", end.signal)
                               : fmt::format("the child process ended with exit code {}", end.exit_code)};
}

}  // namespace aspic
