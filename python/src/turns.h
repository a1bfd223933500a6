#pragma once
// Threads at one simulation, one after the other.
#include <condition_variable>
#include <cstdint>
#include <mutex>

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
  void unlock() {
    {
      const std::lock_guard guard(mutex_);
      ++now_;
    }
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0, now_ = 0;
};

}  // namespace aspic::python
