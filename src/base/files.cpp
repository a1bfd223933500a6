#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/end_request.h"
#include "base/printable.h"

namespace aspic {
namespace {

std::string_view remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "Free some space or choose another disk. No incomplete file was left behind.";
    case EFBIG:
      return "The file would exceed a limit of the file system or of this process (ulimit -f). Choose "
             "another disk or raise the limit.";
    case EACCES:
    case EPERM:
      return "Choose a place where you have permission.";
    case EROFS:
      return "The file system is read-only: choose another place.";
    case ENOENT:
    case ENOTDIR:
      return "Check the spelling, and that the directory exists.";
    case EISDIR:
      return "Give the name of a file, not of a directory.";
    case ENAMETOOLONG:
      return "Choose a shorter name.";
    case EMFILE:
    case ENFILE:
      return "Too many files are open: close other programs or raise the limit (ulimit -n).";
    default:
      return "Check the path and the disk, then try again.";
  }
}

}  // namespace

Error file_error(std::string_view verb, const std::string& path, int error_number) {
  return fail(ErrorCode::io, "Cannot {} {}: {}. {}", verb,
              path.empty() ? "a file without a name" : printable_line(path), std::strerror(error_number),
              remedy(error_number));
}

namespace {

/// Waits for a pipe or a terminal to have something; false if the program is asked to end meanwhile. What
/// cannot be waited for, such as a regular file, is ready.
bool wait_for_input(int descriptor) {
  pollfd input = {descriptor, POLLIN, 0};
  for (;;) {
    const int ready = ::poll(&input, 1, 100);
    if (ready != 0 && !(ready < 0 && errno == EINTR)) return true;
    if (end_requested) return false;
  }
}

/// Reads until `most` bytes are there or the file ends; closes the descriptor, which is opened with
/// O_NONBLOCK.
Result<std::string> read_and_close(int descriptor, std::uint64_t most, const std::string& path) {
  std::string content;
  std::array<char, 65536> block;
  int reason = 0;
  bool interrupted = false;
  while (reason == 0 && content.size() < most) {
    if ((interrupted = !wait_for_input(descriptor))) break;
    const std::size_t wanted = std::min<std::uint64_t>(block.size(), most - content.size());
    const ssize_t got = ::read(descriptor, block.data(), wanted);
    if (got == 0) break;
    if (got > 0) {
      content.append(block.data(), static_cast<std::size_t>(got));
    } else if (errno != EINTR && errno != EAGAIN) {
      reason = errno;
    }
  }
  ::close(descriptor);
  if (interrupted)
    return fail(ErrorCode::interrupted, "interrupted while {} was silent.", printable_line(path));
  if (reason != 0) return file_error("read", path, reason);
  return content;
}

Error too_large(const std::string& path, std::uint64_t most) {
  return fail(ErrorCode::io, "{} is larger than {}, the limit for such a file.", printable_line(path),
              human_bytes(most));
}

/// Opening a pipe without a writer would wait for one: reading does, and can be interrupted.
int open_to_read(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
}

}  // namespace

Result<std::string> read_file(const std::string& path, std::uint64_t most_bytes) {
  const int descriptor = open_to_read(path);
  if (descriptor < 0) return file_error("read", path, errno);
  struct stat present = {};
  if (::fstat(descriptor, &present) == 0 && S_ISREG(present.st_mode) &&
      static_cast<std::uint64_t>(present.st_size) > most_bytes) {
    ::close(descriptor);
    return too_large(path, most_bytes);
  }
  // One byte more reveals what is too large and does not say so.
  auto content = read_and_close(descriptor, most_bytes + 1, path);
  if (content && content->size() > most_bytes) return too_large(path, most_bytes);
  return content;
}

Result<FileStart> read_regular_file(const std::string& path, std::uint64_t most) {
  const int descriptor = open_to_read(path);
  if (descriptor < 0) return file_error("read", path, errno);
  struct stat present = {};
  const bool known = ::fstat(descriptor, &present) == 0;
  if (!known || !S_ISREG(present.st_mode)) {
    const int reason = known ? EISDIR : errno;
    ::close(descriptor);
    if (!known || S_ISDIR(present.st_mode)) return file_error("read", path, reason);
    return fail(ErrorCode::io, "Cannot read {}: it is a device or a pipe. Give the name of a file.",
                printable_line(path));
  }
  ASPIC_TRY(auto content, read_and_close(descriptor, most, path));
  return FileStart{std::move(content), static_cast<std::uint64_t>(present.st_size)};
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool is_device_or_pipe(const std::string& path) {
  std::error_code failed;
  const auto kind = std::filesystem::status(path, failed).type();
  using std::filesystem::file_type;
  return kind == file_type::character || kind == file_type::block || kind == file_type::fifo ||
         kind == file_type::socket;
}

}  // namespace aspic
