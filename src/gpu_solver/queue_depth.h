#pragma once
// How much is queued on a device between two looks at it.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "gpu/read_ring.h"

namespace aspic {

/// Queues under way: one is carried out while the host hears of the one before.
constexpr std::size_t most_queues = 2;
static_assert(most_queues <= gl::ReadRing::capacity);

/// As many steps, or rounds of a solve, as take about a twentieth of a second by the latest measurement:
/// enough to hide the wait, few enough to answer Ctrl-C and to stay far below what systems let a queue take.
/// Begins with few, since a first step may take seconds; never affects the bits.
class QueueDepth {
 public:
  /// `most` ≥ 1: never more; `first`: before anything is known.
  explicit QueueDepth(std::uint32_t most, std::uint32_t first = 1)
      : most_(most), depth_(std::min(first, most)) {}

  std::uint32_t next() const { return depth_; }
  /// `count` of them took so long [s].
  void took(std::uint32_t count, double seconds) {
    if (count == 0) return;
    const double fits = target / std::max(seconds / count, 1e-9);
    // What a few took says little of many.
    depth_ = static_cast<std::uint32_t>(std::clamp(fits, 1.0, std::max(4.0 * count, 1.0 * depth_)));
    depth_ = std::clamp(depth_, 1u, most_);
  }

 private:
  static constexpr double target = 0.05;  // s
  std::uint32_t most_, depth_;
};

}  // namespace aspic
