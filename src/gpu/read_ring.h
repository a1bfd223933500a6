#pragma once
// Small copies of buffers on their way back from the device, several at once.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/fence.h"
#include "gpu/name.h"

namespace aspic::gl {

/// A ring of read buffers with fences. Buffers that the solver writes are never mapped or read: some drivers
/// move a buffer that is (NVIDIA's message 131186) to the host's memory, and later passes with it. Its
/// context must outlive it and be current.
class ReadRing {
 public:
  /// Copies under way at once.
  static constexpr std::size_t capacity = 3;

  /// Makes the buffers. Where there is no memory for them, Context::check() says so.
  ReadRing(Context& context, std::uint64_t bytes);

  bool full() const { return pending_ == capacity; }
  std::size_t pending() const { return pending_; }

  /// Queues a copy of `bytes` bytes, at most the ring's, from byte `offset` of `source` on; legal unless
  /// full(). A pass's output is visible only if that pass, or one after it, named ReadBy::read_back.
  void submit(const Buffer& source, std::uint64_t offset, std::uint64_t bytes);
  /// Whether the oldest copy has arrived; legal while pending() > 0. Never waits.
  bool ready();
  /// The oldest copy, of data.size() bytes at most; waits for it. Legal while pending() > 0. Of a lost
  /// device, all bits are set, and Context::check() says what happened.
  void take(std::span<std::byte> data);
  /// Calls `read` with the first `bytes` of the oldest copy, where they lie, and waits for it. Legal while
  /// pending() > 0. False: the device is lost, and nothing was called.
  bool take(std::uint64_t bytes, const std::function<void(std::span<const std::byte>)>& read);
  /// Drops all copies under way.
  void forget();

 private:
  Context* context_;
  std::vector<Name> buffers_;
  std::vector<Fence> fences_;
  std::size_t first_ = 0, pending_ = 0;
};

}  // namespace aspic::gl
