#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <thread>
#include <utility>

#include "base/end_request.h"
#include "base/printable.h"
#include "io/console.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 18;

// Paths of temporary files, readable by a signal handler: fixed storage, published by a lock-free state.
struct TemporarySlot {
  enum State { free, opening, open };
  std::atomic<int> state{free};
  char path[PATH_MAX] = {};
};
std::array<TemporarySlot, 64> temporary_slots;
std::atomic<bool> removing{false};  // remove_temporary_files() was called: no more are made
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// Nothing (−1) when all slots are taken or the path is too long: the file is then removed by its destructor
/// only.
int remember_temporary(const std::string& path) {
  if (path.size() >= PATH_MAX) return -1;
  for (std::size_t i = 0; i < temporary_slots.size(); ++i) {
    int expected = TemporarySlot::free;
    if (!temporary_slots[i].state.compare_exchange_strong(expected, TemporarySlot::opening)) continue;
    std::memcpy(temporary_slots[i].path, path.c_str(), path.size() + 1);
    return static_cast<int>(i);
  }
  return -1;
}

void set_state(int slot, TemporarySlot::State state) {
  if (slot >= 0) temporary_slots[static_cast<std::size_t>(slot)].state.store(state);
}

/// While one lives, the signals that end the program are handled by other threads, or later.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t ends;
    sigemptyset(&ends);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ends, number);
    ::pthread_sigmask(SIG_BLOCK, &ends, &before_);
  }
  ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_ = {};
};

/// Opens a new temporary file, which remove_temporary_files() removes whenever it is called. Returns its
/// descriptor, or −1 with errno.
int open_temporary(const std::string& path, int& slot) {
  const SignalsHeld held;
  slot = remember_temporary(path);
  const int descriptor = removing ? -1 : ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (removing && descriptor < 0) errno = EINTR;
  set_state(slot, descriptor < 0 ? TemporarySlot::free : TemporarySlot::open);
  if (descriptor < 0) slot = -1;
  return descriptor;
}

std::string directory_of(const std::string& path) {
  const std::string directory = fs::path(path).parent_path();
  return directory.empty() ? "." : directory;
}

/// Opens a device or a pipe. A pipe cannot be opened until it has a reader, which may never come.
Result<int> open_directly(const std::string& path, bool pipe) {
  for (;;) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (descriptor >= 0) return descriptor;
    if (errno != EINTR && !(pipe && errno == ENXIO)) return file_error("write", path, errno);
    if (end_requested)
      return fail(ErrorCode::interrupted, "interrupted before a reader opened the pipe {}.",
                  printable_line(path));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

/// How long a reader that has stopped is waited for once the program is to end.
constexpr auto reader_patience = std::chrono::seconds(2);

Error already_exists(const std::string& path) {
  return advised(fail(ErrorCode::io, "{} already exists and was not changed.", printable_line(path)),
                 {advice("choose another name"), {RemedyKind::overwrite}});
}

}  // namespace

std::string written_path(const std::string& path) {
  std::error_code failed;
  const fs::path resolved = fs::canonical(path, failed);
  if (!failed) return resolved.string();
  fs::path at = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, failed)); ++links) {
    const fs::path target = fs::read_symlink(at, failed);
    constexpr int most_links = 40;  // the system's own limit
    if (failed || links == most_links) return path;
    at = at.parent_path() / target;  // which is `target` alone if that is absolute
  }
  return at.string();
}

Result<AtomicFile> AtomicFile::create(const std::string& path, Overwrite overwrite) {
  AtomicFile file;
  file.path_ = path;
  file.overwrite_ = overwrite;
  if (path.empty()) return file_error("write", path, ENOENT);

  struct stat present = {};
  const bool exists = ::stat(path.c_str(), &present) == 0;
  if (exists && S_ISDIR(present.st_mode)) return file_error("write", path, EISDIR);
  if (exists && !S_ISREG(present.st_mode)) {
    ASPIC_TRY(file.descriptor_, open_directly(path, S_ISFIFO(present.st_mode)));
    return file;
  }
  if (!exists && errno == ELOOP) return file_error("write", path, errno);
  if (exists && overwrite == Overwrite::refuse) return already_exists(path);
  // Renaming would succeed over a file that is closed to writing: its owner's wish counts.
  if (exists && ::access(path.c_str(), W_OK) != 0) return file_error("write", path, errno);

  file.target_ = written_path(path);
  static std::atomic<unsigned> counter{0};
  const std::string directory = directory_of(file.target_);
  for (int attempt = 0; file.descriptor_ < 0; ++attempt) {
    file.temporary_ = fmt::format("{}/.aspic-{}-{}.tmp", directory, ::getpid(), counter++);
    file.descriptor_ = open_temporary(file.temporary_, file.slot_);
    if (file.descriptor_ < 0 && (errno != EEXIST || attempt == 1000)) {
      const int reason = errno;
      std::error_code unread;
      file.temporary_.clear();
      const bool link = fs::is_symlink(fs::symlink_status(path, unread));
      return file_error("write", link ? fmt::format("{} through the link {}", file.target_, path) : path,
                        reason);
    }
  }
  if (exists) (void)::fchmod(file.descriptor_, present.st_mode & 07777);
  return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept {
  *this = std::move(other);
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  path_ = std::move(other.path_);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  buffer_ = std::move(other.buffer_);
  descriptor_ = std::exchange(other.descriptor_, -1);
  slot_ = std::exchange(other.slot_, -1);
  overwrite_ = other.overwrite_;
  return *this;
}

AtomicFile::~AtomicFile() {
  discard();
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  set_state(std::exchange(slot_, -1), TemporarySlot::free);
}

Error AtomicFile::give_up(int reason) {
  struct stat own = {}, output = {};
  const bool is_output = reason == EPIPE && ::fstat(descriptor_, &own) == 0 &&
                         ::fstat(STDOUT_FILENO, &output) == 0 && own.st_dev == output.st_dev &&
                         own.st_ino == output.st_ino;
  discard();
  return is_output ? Error{closed_pipe, ""} : file_error("write", path_, reason);
}

Status AtomicFile::require_open() const {
  if (descriptor_ >= 0) return {};
  return fail(ErrorCode::io, "{} was discarded after an earlier error.", path_);
}

Status AtomicFile::write(std::string_view text) {
  ASPIC_CHECK(require_open());
  buffer_ += text;
  return buffer_.size() >= buffer_size ? flush() : Status{};
}

Status AtomicFile::flush() {
  Patience patience(reader_patience);
  for (std::size_t done = 0; done < buffer_.size();) {
    const ssize_t written = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
      patience.renew();
    } else if (errno == EAGAIN) {  // a full pipe
      pollfd room = {descriptor_, POLLOUT, 0};
      (void)::poll(&room, 1, 100);
      if (!patience.over()) continue;
      discard();
      return fail(ErrorCode::io, "Cannot complete {}: its reader has stopped.", printable_line(path_));
    } else if (errno != EINTR) {
      return give_up(errno);
    }
  }
  buffer_.clear();
  return {};
}

Status AtomicFile::replace(std::uint64_t offset, std::string_view bytes) {
  ASPIC_CHECK(require_open());
  ASPIC_CHECK(flush());
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return give_up(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  return {};
}

Status AtomicFile::give_final_name() {
  if (overwrite_ == Overwrite::refuse) {
    // link() refuses an existing name in one step; rename() would replace a file made since create() looked.
    if (::link(temporary_.c_str(), target_.c_str()) == 0) {
      ::unlink(temporary_.c_str());
      return {};
    }
    if (errno == EEXIST) return already_exists(path_);
    if (::access(target_.c_str(), F_OK) == 0)
      return already_exists(path_);  // a file system without hard links
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return file_error("write", path_, errno);
  return {};
}

Status AtomicFile::commit(bool wait) {
  ASPIC_CHECK(require_open());
  ASPIC_CHECK(flush());
  const bool device = temporary_.empty();
  if (wait && !device && ::fsync(descriptor_) != 0) return give_up(errno);
  if (::close(std::exchange(descriptor_, -1)) != 0) return give_up(errno);
  if (device) return {};
  if (const Status named = give_final_name(); !named) {
    discard();
    return named;
  }
  temporary_.clear();
  set_state(std::exchange(slot_, -1), TemporarySlot::free);
  const int directory = ::open(directory_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    // The content is safe already; whether the name survives a power cut is all that this decides.
    (void)::fsync(directory);
    ::close(directory);
  }
  return {};
}

void remove_temporary_files() noexcept {
  removing = true;
  for (TemporarySlot& slot : temporary_slots) {
    // Another thread is about to open it, or this one failed while it was.
    constexpr timespec nap = {0, 1'000'000};
    for (int n = 0; n < 1000 && slot.state.load() == TemporarySlot::opening; ++n) ::nanosleep(&nap, nullptr);
    if (slot.state.load() != TemporarySlot::free) ::unlink(slot.path);
  }
}

}  // namespace aspic
