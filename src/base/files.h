#pragma once
// Reading files, and what to say when the system refuses one.
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "base/result.h"

namespace aspic {

/// The bytes of a file. Error (io): missing, unreadable, a directory, or of more than `most_bytes`.
Result<std::string> read_file(const std::string& path,
                              std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

/// The beginning of a file, and the size of all of it.
struct FileStart {
  std::string content;
  std::uint64_t size = 0;  ///< [bytes]
};
/// Reads the first `most` bytes, or all if there are fewer, of a regular file. Errors (io): it is missing or
/// unreadable, a directory, or a device or pipe, which may have no end.
Result<FileStart> read_regular_file(const std::string& path, std::uint64_t most);

/// The error for a failed system call on a file: "Cannot <verb> <path>: <reason>. <remedy>".
Error file_error(std::string_view verb, const std::string& path, int error_number);

}  // namespace aspic
