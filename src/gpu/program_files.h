#pragma once
// Program binaries in files of the user, so that the next start compiles nothing.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace aspic::gl {

/// The folder of program binaries: the environment variable ASPIC_SHADER_CACHE, otherwise
/// $XDG_CACHE_HOME/aspic/programs, otherwise ~/.cache/aspic/programs. Empty: none, since the variable is
/// "off" or no home directory is known.
std::filesystem::path program_folder();

/// A linked program as glGetProgramBinary returns it.
struct ProgramBinary {
  std::uint32_t format = 0;
  std::string bytes;
};

/// Binaries by key, one file each. It is a cache: a file that cannot be read or written is no error, and any
/// number of processes share a folder. Files and folders that it makes are the user's alone.
class ProgramFiles {
 public:
  /// Beyond this the least recently used files are removed.
  static constexpr std::uint64_t default_most_bytes = std::uint64_t{64} << 20;

  /// An empty folder: nothing is kept.
  explicit ProgramFiles(std::filesystem::path folder, std::uint64_t most_bytes = default_most_bytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  /// The binary of this key. Nothing where there is none, or its file is damaged, belongs to another key, or
  /// may be written by other users.
  std::optional<ProgramBinary> load(const std::string& key) const;
  /// Keeps a binary. The file appears complete or not at all. `key` has letters and digits alone.
  void store(const std::string& key, const ProgramBinary& binary);

  const std::filesystem::path& folder() const { return folder_; }
  /// Bytes that the folder's files take.
  std::uint64_t bytes() const;

 private:
  void prune() const;

  std::filesystem::path folder_;
  std::uint64_t most_bytes_;
  std::optional<std::uint64_t> bytes_;  // as of the last store(), by this process's knowledge
};

}  // namespace aspic::gl
