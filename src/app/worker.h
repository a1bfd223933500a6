#pragma once
// One thread for work that must not hold up the picture.
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace aspic::app {

/// Runs one job at a time. All calls from one thread, the window's. An exception that leaves a job, such as
/// the want of memory, comes out of the next start(), finish() or wait() there.
class Worker {
 public:
  /// A job looks at the flag now and then and comes to an early end once it is true.
  using Job = std::function<void(const std::atomic<bool>& hurry)>;

  Worker();
  /// Hurries the job under way and waits for it.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Legal while not busy().
  void start(Job job);
  bool busy() const;
  /// Hurries the job under way, if any, and waits for its end: its results may be read then.
  void finish();
  /// The same for destructors: a job's exception is kept.
  void abandon() noexcept;
  /// Waits without hurrying it.
  void wait();

 private:
  void loop();
  void await_end();
  void rethrow();
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Job job_;
  bool busy_ = false, end_ = false;
  std::exception_ptr failure_;
  std::atomic<bool> hurry_ = false;
  std::thread thread_;
};

}  // namespace aspic::app
