#pragma once
// A run's work on another thread, and what the run's own thread does with its results.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>

#include "base/result.h"
#include "playback/worker.h"

namespace aspic {

/// All calls from one thread, the run's.
class Jobs {
 public:
  /// What the run's thread does with a result.
  using TakeUp = std::function<Status()>;
  /// Runs on the other thread. Ends early once the flag is true, or takes no notice of it.
  using Job = std::function<TakeUp(const std::atomic<bool>& canceled)>;

  /// Begins a job once those before it have ended.
  void start(Job job);
  /// A job that cancel() leaves alone. No other has begun.
  void start_uncanceled(Job job);
  /// Takes up the results that there are, in order. Error: that of the first that has one; later ones are
  /// still there then. Throws what left a job.
  Status collect();
  /// Cancels the job in progress without waiting for it, and forgets those that have not begun.
  void cancel();
  /// Cancels and waits for the end; the results are still to be collected, or to be forgotten.
  void finish() { worker_.finish(); }
  void wait() { worker_.wait(); }
  /// Drops results, but not that of a job that cancel() leaves alone.
  void forget() {
    if (!uncanceled_) results_.clear();
  }

  /// Jobs that have not ended.
  std::size_t count() const { return worker_.jobs(); }
  bool busy() const { return worker_.busy(); }
  bool has_news() const { return !results_.empty(); }
  /// Nothing is under way, and nothing to be taken up.
  bool idle() const { return !busy() && !has_news(); }
  /// The job in progress takes longer than an image should.
  bool long_under_way() const;

 private:
  std::chrono::steady_clock::time_point progress_ = {};  // a job began, or had a result
  bool uncanceled_ = false;                              // the job in progress, or its result, is to stay
  Mailbox<TakeUp> results_;
  Worker worker_;  // last: its jobs put results
};

}  // namespace aspic
