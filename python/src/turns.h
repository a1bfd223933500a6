#pragma once
// Threads at one simulation or batch, one after the other.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>

namespace aspic::python {

/// Lets threads in in the order in which they ask: one that reads gets in between the chunks of one that
/// steps. Not recursive. To be waited for without the GIL.
class Turns {
 public:
  void lock() {
    std::unique_lock guard(mutex_);
    const std::uint64_t mine = next_++;
    changed_.wait(guard, [&] { return mine == now_; });
  }
  /// lock(), but asks several times a second whether to give up: then false, and there is nothing to unlock.
  template <class F>
  bool lock_unless(const F& given_up) {
    std::unique_lock guard(mutex_);
    const std::uint64_t mine = next_++;
    while (!changed_.wait_for(guard, std::chrono::milliseconds(50), [&] { return mine == now_; })) {
      guard.unlock();
      const bool gone = given_up();
      guard.lock();
      if (!gone) continue;
      gone_.insert(mine);
      pass_on();
      return false;
    }
    return true;
  }
  void unlock() {
    const std::lock_guard guard(mutex_);
    ++now_;
    pass_on();
  }

 private:
  /// Over those that have given up.
  void pass_on() {
    while (gone_.erase(now_) > 0) ++now_;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0, now_ = 0;
  std::set<std::uint64_t> gone_;  // have given up, and their turn is to come
};

}  // namespace aspic::python
