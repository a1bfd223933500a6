#pragma once
// Reading files, and messages for files that the system refuses.
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace aspic {

/// What a checkpoint begins with (docs/files.md). As in PNG: a byte above 127, a line end of each kind and an
/// end-of-file mark reveal transfers that alter text.
inline constexpr std::string_view checkpoint_mark =
    "\x89"
    "ASPIC\r\n\x1a\n";

/// What a text file may hold: no scene needs more, and a device or a pipe may have no end.
inline constexpr std::uint64_t largest_text_file = std::uint64_t{64} << 20;  ///< [bytes]

/// The bytes of a file, device or pipe. Errors: io, it is missing, unreadable, a directory, or of more than
/// `most_bytes`, which is found out without reading it where it is a regular file; interrupted, the program
/// was asked to end while a pipe was silent.
Result<std::string> read_file(const std::string& path, std::uint64_t most_bytes = largest_text_file);

/// The beginning of a file, and the size of all of it.
struct FileStart {
  std::string content;
  std::uint64_t size = 0;  ///< [bytes]
};
/// Reads the first `most` bytes, or all if there are fewer, of a regular file. Errors (io): it is missing or
/// unreadable, a directory, or a device or pipe, which may have no end.
Result<FileStart> read_regular_file(const std::string& path, std::uint64_t most);

/// What a file's name ends in, in lower case, ".csv"; empty: nothing.
std::string ending_of(const std::string& path);

/// Whether there is a device or a pipe of that name, whose name says nothing of what is written into it.
bool is_device_or_pipe(const std::string& path);

/// The error for a failed system call on a file: "Cannot <verb> <path>: <reason>. <remedy>".
Error file_error(std::string_view verb, const std::string& path, int error_number);

}  // namespace aspic
