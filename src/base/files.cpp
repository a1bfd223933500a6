#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/printable.h"

namespace aspic {
namespace {

std::string_view remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "Free some space or choose another disk; nothing incomplete was left behind.";
    case EFBIG:
      return "The file would be larger than the file system or the limit of this process (ulimit -f) allows.";
    case EACCES:
    case EPERM:
      return "Choose a place you have permission for.";
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

/// Reads until `most` bytes are there or the file ends; closes the descriptor.
Result<std::string> read_and_close(int descriptor, std::uint64_t most, const std::string& path) {
  std::string content;
  std::array<char, 65536> block;
  int reason = 0;
  while (reason == 0 && content.size() < most) {
    const std::size_t wanted = std::min<std::uint64_t>(block.size(), most - content.size());
    const ssize_t got = ::read(descriptor, block.data(), wanted);
    if (got == 0) break;
    if (got > 0) {
      content.append(block.data(), static_cast<std::size_t>(got));
    } else if (errno != EINTR) {
      reason = errno;
    }
  }
  ::close(descriptor);
  if (reason != 0) return file_error("read", path, reason);
  return content;
}

}  // namespace

Result<std::string> read_file(const std::string& path, std::uint64_t most_bytes) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return file_error("read", path, errno);
  // One byte more reveals a file that is too large.
  constexpr std::uint64_t all = std::numeric_limits<std::uint64_t>::max();
  auto content = read_and_close(descriptor, most_bytes == all ? all : most_bytes + 1, path);
  if (content && content->size() > most_bytes) {
    return fail(ErrorCode::io, "{} is larger than {}, the limit for such a file.", printable_line(path),
                human_bytes(most_bytes));
  }
  return content;
}

Result<FileStart> read_regular_file(const std::string& path, std::uint64_t most) {
  // Opening a pipe without a writer would wait for one.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return file_error("read", path, errno);
  struct stat present = {};
  const bool known = ::fstat(descriptor, &present) == 0;
  if (!known || !S_ISREG(present.st_mode)) {
    const int reason = known ? EISDIR : errno;
    ::close(descriptor);
    if (!known || S_ISDIR(present.st_mode)) return file_error("read", path, reason);
    return fail(ErrorCode::io,
                "Cannot read {}: it is a device or a pipe, which may have no end. Give the name of a file.",
                printable_line(path));
  }
  ASPIC_TRY(auto content, read_and_close(descriptor, most, path));
  return FileStart{std::move(content), static_cast<std::uint64_t>(present.st_size)};
}

}  // namespace aspic
