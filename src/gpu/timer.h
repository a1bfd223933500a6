#pragma once
// Device time between two points of the command stream, without waiting for it.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gpu/context.h"

namespace aspic::gl {

/// A ring of pairs of GL_TIMESTAMP queries (GL_TIME_ELAPSED reads 0 around compute on llvmpipe). Its context
/// must outlive it and be current.
class Timer {
 public:
  /// Measurements that may be under way at once.
  static constexpr std::size_t capacity = 16;

  explicit Timer(Context& context);
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Starts a measurement. False, and end() will do nothing, when `capacity` results lie unread. Does not
  /// nest.
  bool begin();
  void end();
  /// The oldest finished measurement [ns], each once; nothing while the device is still at it. Never waits.
  std::optional<std::uint64_t> poll();
  /// The oldest measurement [ns], waiting for the device; nothing if none is under way.
  std::optional<std::uint64_t> wait();
  /// Measurements ended and not yet read.
  std::size_t pending() const { return pending_; }

 private:
  std::uint64_t take();
  std::array<std::array<std::uint32_t, 2>, capacity> queries_ = {};
  std::size_t first_ = 0;
  std::size_t pending_ = 0;
  bool running_ = false;
};

}  // namespace aspic::gl
