#pragma once
// A run put aside: the whole scene and the state at full precision in one file, format in docs/files.md.
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "io/atomic_file.h"
#include "model/state.h"

namespace aspic {

/// Version of the checkpoint format this program writes, and the only one it reads.
inline constexpr std::uint32_t checkpoint_version = 2;

struct Checkpoint {
  std::string program_version;  ///< of the program that wrote it
  std::string scene;            ///< the complete scene as TOML, overrides applied
  double timestep = 0.0;        ///< h [s], the scene's own: repeated to be seen without parsing
  State state;                  ///< with its precision and step
};

/// The bytes of a checkpoint.
std::string encode_checkpoint(const Checkpoint& checkpoint);

/// Reads bytes back. `name` is for messages. Errors (io): not a checkpoint, another format version, damaged
/// or cut short (its checksum or the hash of its state does not match).
Result<Checkpoint> decode_checkpoint(std::string_view bytes, const std::string& name);

/// Writes to an open file; the caller commits. Error (diverged) if a value of the state is not finite.
Status write_checkpoint(AtomicFile& file, const Checkpoint& checkpoint);

/// Reads a file.
Result<Checkpoint> read_checkpoint(const std::string& path);

}  // namespace aspic
