#pragma once
// Threads at one simulation or batch, one after the other.
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>

#include "convert.h"

namespace aspic::python {

/// Lets threads in in the order in which they ask: one that reads gets in between the chunks of one that
/// steps. Not recursive. To be waited for without the GIL. A child process has its own, and an error where
/// another thread was at work when the process forked.
class Turns {
 public:
  void lock() {
    look_for_fork();
    std::unique_lock guard(mutex_);
    const std::uint64_t mine = next_++;
    changed_.wait(guard, [&] { return mine == now_; });
  }
  /// lock(), but asks several times a second whether to give up: then false, and there is nothing to unlock.
  template <class F>
  bool lock_unless(const F& given_up) {
    look_for_fork();
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
  /// Nobody else is in a child's first call. What the mutex was is unknown there, so both are made anew.
  void look_for_fork() {
    if (const std::uint64_t now = forks(); forks_ != now) {
      forks_ = now;
      busy_at_fork_ = busy_at_fork_ || now_ != next_;
      std::construct_at(&mutex_);
      std::construct_at(&changed_);
      next_ = now_ = 0;
      gone_.clear();
    }
    if (busy_at_fork_)
      throw LibraryError({ErrorCode::no_device,
                          "another thread was using this object when the process forked, so its copy here is "
                          "incomplete: make a new one in the child process, or start it by 'spawn'"});
  }

  /// Over those that have given up.
  void pass_on() {
    while (gone_.erase(now_) > 0) ++now_;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0, now_ = 0;
  std::set<std::uint64_t> gone_;  // have given up, and their turn is to come
  std::uint64_t forks_ = forks();
  bool busy_at_fork_ = false;
};

}  // namespace aspic::python
