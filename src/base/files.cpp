#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/text.h"

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
  return {ErrorCode::io,
          fmt::format("Cannot {} {}: {}. {}", verb, path.empty() ? "a file without a name" : path,
                      std::strerror(error_number), remedy(error_number))};
}

Result<std::string> read_file(const std::string& path, std::uint64_t most_bytes) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return file_error("read", path, errno);
  std::string content;
  std::array<char, 65536> block;
  for (;;) {
    const ssize_t got = ::read(descriptor, block.data(), block.size());
    if (got == 0) break;
    const int reason = errno;
    if (got > 0) {
      content.append(block.data(), static_cast<std::size_t>(got));
      if (content.size() <= most_bytes) continue;
      ::close(descriptor);
      return Error{ErrorCode::io, fmt::format("{} is larger than {}, the most that is read of such a file.",
                                              path, human_bytes(most_bytes))};
    }
    if (reason == EINTR) continue;
    ::close(descriptor);
    return file_error("read", path, reason);
  }
  ::close(descriptor);
  return content;
}

}  // namespace aspic
