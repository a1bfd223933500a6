#pragma once
// One job at a time that must not hold up the picture, in a thread of its own.
#include <atomic>
#include <functional>
#include <future>

namespace aspic::app {

/// All calls from one thread, the window's. An exception that leaves a job, such as running out of memory,
/// comes out of the next start(), finish() or wait() there.
class Worker {
 public:
  /// A job looks at the flag now and then and comes to an early end once it is true.
  using Job = std::function<void(const std::atomic<bool>& hurry)>;

  Worker() = default;
  /// Hurries the job in progress and waits for it.
  ~Worker() { abandon(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Legal while not busy().
  void start(Job job);
  bool busy() const;
  /// Hurries the job in progress, if any, and waits for its end: its results may be read then.
  void finish();
  /// The same for destructors: a job's exception is kept.
  void abandon() noexcept;
  /// Waits without hurrying it.
  void wait();

 private:
  std::atomic<bool> hurry_ = false;
  std::future<void> job_;
};

}  // namespace aspic::app
