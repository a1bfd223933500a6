#pragma once
// Files that appear complete or not at all: written under a temporary name in their directory and renamed
// when complete.
#include <cstdint>
#include <string>
#include <string_view>

#include "aspic/files.h"
#include "base/files.h"
#include "base/result.h"

namespace aspic {

/// An output file being written. Until commit() nothing has the final name; a file that is never
/// committed (an error, an exception, Ctrl-C) leaves nothing behind. A symbolic link stays, and what it names
/// is written, whether that exists or not. A path that names a device or pipe, such as /dev/stdout, is
/// written directly, since renaming would replace the device; a reader that stops reading is waited for until
/// the program is asked to end.
///
/// Every error has ErrorCode::io and says the path, what the system said, and a remedy.
class AtomicFile {
 public:
  /// Opens the temporary file, which proves that the directory exists and may be written to: call it before
  /// the work whose result the file shall hold. A pipe is waited for until it has a reader. Errors: the
  /// directory is missing or closed to us, the path is a directory, a file is there already and `overwrite`
  /// is refuse, or (interrupted) the program was asked to end before a pipe had a reader.
  static Result<AtomicFile> create(const std::string& path, Overwrite overwrite);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  /// Appends; buffered. After an error the file can only be discarded.
  Status write(std::string_view text);

  /// Replaces bytes that were written before, from `offset` on; not of a device or a pipe. Afterwards as
  /// write().
  Status replace(std::uint64_t offset, std::string_view bytes);

  /// Flushes, waits for the disk unless a file that a power cut damages does no harm, and gives the file its
  /// final name. Error too if another program has put a file there in the meantime and overwriting was
  /// refused: neither file is lost then, but this one is discarded.
  Status commit(bool wait = true);

  const std::string& path() const { return path_; }
  /// The temporary file, which another program may write instead of write(); empty for devices and pipes.
  const std::string& temporary_path() const { return temporary_; }

 private:
  AtomicFile() = default;
  Status flush();
  Status give_final_name();
  void discard() noexcept;
  Error give_up(int reason);
  Status require_open() const;

  std::string path_;       ///< as the user gave it
  std::string target_;     ///< written_path() of it
  std::string temporary_;  ///< empty for devices
  std::string buffer_;
  int descriptor_ = -1;
  int slot_ = -1;  ///< in the list that remove_temporary_files() reads
  Overwrite overwrite_ = Overwrite::refuse;
};

/// The file that writing to `path` makes or replaces: symbolic links are followed, also to what does not
/// exist yet. The path itself where a link leads in a circle.
std::string written_path(const std::string& path);

/// Removes the temporary files of this process that are not committed yet; create() makes no more. For a
/// process that is about to end. Safe to call from a signal handler.
void remove_temporary_files() noexcept;

}  // namespace aspic
