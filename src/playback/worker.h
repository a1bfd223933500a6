#pragma once
// Work that must not hold up the image, in a thread of its own.
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace aspic {

/// Jobs one after the other. All calls from one thread, the window's. An exception that leaves a job, such as
/// running out of memory, comes out of the next start(), finish() or wait() there.
class Worker {
 public:
  /// A job looks at the flag now and then and comes to an early end once it is true.
  using Job = std::function<void(const std::atomic<bool>& canceled)>;

  Worker() = default;
  /// Cancels the job in progress and waits for it.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Begins a job once those before it have ended.
  void start(Job job);
  /// Jobs that have not ended.
  std::size_t jobs() const;
  bool busy() const { return jobs() > 0; }
  /// Cancels the job in progress, if any, without waiting for it, and forgets those that have not begun.
  void cancel();
  /// The same, and waits for its end: its results may be read then.
  void finish();
  /// The same for destructors: a job's exception is kept.
  void abandon() noexcept;
  /// Waits for all jobs without canceling them.
  void wait();

 private:
  void work();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;  // the first one is in progress
  std::exception_ptr thrown_;
  bool ending_ = false;
  std::atomic<bool> canceled_ = false;  // the job in progress alone
  std::jthread thread_;                 // from the first job on
};

/// Results on their way from one thread to another, in order.
template <class T>
class Mailbox {
 public:
  void put(T item) {
    const std::scoped_lock lock(mutex_);
    items_.push_back(std::move(item));
  }
  std::optional<T> take() {
    const std::scoped_lock lock(mutex_);
    if (items_.empty()) return std::nullopt;
    std::optional<T> item = std::move(items_.front());
    items_.pop_front();
    return item;
  }
  bool empty() const {
    const std::scoped_lock lock(mutex_);
    return items_.empty();
  }
  void clear() {
    const std::scoped_lock lock(mutex_);
    items_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::deque<T> items_;
};

}  // namespace aspic
