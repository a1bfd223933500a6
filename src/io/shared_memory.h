#pragma once
// Memory that two processes see.
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/result.h"

namespace aspic {

/// Memory without a name, gone with the last process that has it.
class SharedMemory {
 public:
  /// An empty handle.
  SharedMemory() = default;
  /// `bytes` ≥ 1 of zeros, all of which are there: a write to them never fails. Error (io): there is not as
  /// much.
  static Result<SharedMemory> create(std::uint64_t bytes);
  /// That of another process, whose descriptor this one was given and which is closed with the handle. Error
  /// (io): it is none.
  static Result<SharedMemory> open(int descriptor);

  ~SharedMemory();
  SharedMemory(SharedMemory&& other) noexcept;
  SharedMemory& operator=(SharedMemory&& other) noexcept;

  std::span<std::byte> bytes() const { return {start_, size_}; }
  /// For another process (ChildExtras).
  int descriptor() const { return descriptor_; }

 private:
  Status map();

  int descriptor_ = -1;
  std::byte* start_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace aspic
