#pragma once
// Whether the program has been asked to end.
#include <atomic>
#include <chrono>
#include <utility>

namespace aspic {

/// Set by the signals that InterruptGuard catches, and by the window when it closes. What waits for another
/// program or for a pipe then gives it up once it no longer moves.
inline std::atomic<bool> end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // a signal handler sets it

/// How long to wait for something outside: without limit until the program is asked to end, from then on as
/// long as it moves at least once in `limit`.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Patience(Clock::duration limit) : limit_(limit) {}

  /// It has moved.
  void renew() { counting_ = false; }
  bool over() {
    if (!end_requested) return false;
    const auto now = Clock::now();
    if (!std::exchange(counting_, true)) since_ = now;
    return now - since_ > limit_;
  }

 private:
  Clock::duration limit_;
  bool counting_ = false;
  Clock::time_point since_ = {};
};

}  // namespace aspic
