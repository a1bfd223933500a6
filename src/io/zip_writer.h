#pragma once
// Zip archives of uncompressed members of any size.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "io/atomic_file.h"

namespace aspic {

/// CRC-32 of bytes that follow others, as zip has it; `before` is that of the others, 0 of none.
std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0);
/// That of two pieces one after the other, of which the second has `size` bytes.
std::uint32_t joined_crc_of(std::uint32_t first, std::uint32_t second, std::uint64_t size);

/// Writes an archive (zip64, version 4.5 of PKWARE's APPNOTE) into a file, front to back.
class ZipWriter {
 public:
  /// The file must outlive it.
  explicit ZipWriter(AtomicFile& file) : file_(file) {}
  /// Begins a member; write() then gets exactly `size` bytes with this checksum. Error (io).
  Status begin(const std::string& name, std::uint64_t size, std::uint32_t checksum);
  /// Error (io).
  Status write(std::string_view bytes);
  /// The table of members; the file is left to be committed. Error (io).
  Status finish();

 private:
  struct Member {
    std::string name;
    std::uint64_t size, offset;
    std::uint32_t checksum;
  };
  AtomicFile& file_;
  std::vector<Member> members_;
  std::uint64_t offset_ = 0;
};

}  // namespace aspic
