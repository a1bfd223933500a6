#pragma once
// The bytes of a checkpoint; format in docs/files.md.
#include <cstdint>
#include <string>
#include <string_view>

#include "aspic/files.h"
#include "aspic/settings.h"
#include "io/atomic_file.h"

namespace aspic {

/// Version of the checkpoint format this program writes, and the oldest that it reads.
inline constexpr std::uint32_t checkpoint_version = 3;
inline constexpr std::uint32_t oldest_checkpoint_version = 2;

/// Bounds of a checkpoint's contents: no aspic writes more.
inline constexpr std::size_t longest_program_version = 64;
inline constexpr std::uint64_t longest_scene = std::uint64_t{64} << 20;  ///< bytes, as of a scene file
inline constexpr std::uint64_t longest_inputs = longest_scene;           ///< bytes
inline constexpr std::uint64_t last_checkpoint_step = std::uint64_t{1}
                                                      << 53;  ///< as far as double precision counts

/// The bytes of a checkpoint.
std::string encode_checkpoint(const Checkpoint& checkpoint);

/// Reads bytes back. `name` is for messages. Errors (io): not a checkpoint, another format version, damaged
/// or cut short (its checksum or the hash of its state does not match, a number is out of its bounds or not
/// finite). Nothing is allocated for sizes that the file names before they are found to fit the file.
Result<Checkpoint> decode_checkpoint(std::string_view bytes, const std::string& name);

/// Writes to an open file; the caller commits. Error (diverged) if a value of the state is not finite.
Status write_checkpoint(AtomicFile& file, const Checkpoint& checkpoint);

/// Error (io): the checkpoint's time step is not the scene's, or (scene_rejected) its state has other numbers
/// of particles and balls than the scene; found without building the scene's model.
Status check_against_scene(const Checkpoint& checkpoint, const ModelSettings& scene, const std::string& name);

}  // namespace aspic
