#pragma once
// Bytes that are written during a run and read again at its end.
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace aspic {

/// A file without a name: nothing is left of it, however the program ends.
class Spool {
 public:
  /// In the directory of `path`, of which errors (io) speak.
  static Result<Spool> create(const std::string& path);
  Spool(Spool&& other) noexcept;
  Spool& operator=(Spool&& other) noexcept;
  ~Spool();

  /// Error (io), as of a full disk.
  Status append(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  /// Fills `bytes` with those from `offset` on, which were appended. Error (io).
  Status read(std::uint64_t offset, std::string& bytes) const;

 private:
  Spool() = default;
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace aspic
