#pragma once
// Threads that share the pieces of a task. A pool of our own, since a step of a small cube takes 10 µs: a
// general scheduler's start and end would take as long.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "base/result.h"

namespace aspic::parallel {

class Workers {
 public:
  /// `threads` ≥ 1, the caller's own among them.
  explicit Workers(unsigned threads);
  /// Without threads: whoever is in help() takes pieces, up to `threads` with the caller.
  static std::shared_ptr<Workers> of_helpers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const { return threads_; }
  /// Which of them a task runs on, from 0.
  unsigned current() const { return threads_ == 1 ? 0 : current_thread(); }
  /// Which thread of its pool this one is, from 0; 0 outside of all pools.
  static unsigned current_thread();

  /// Calls task(n) for every n below `pieces`, in any order and on any thread, and returns when all are done.
  /// What the pieces wrote is visible then. The task must not throw.
  void run(std::size_t pieces, const std::function<void(std::size_t)>& task);

  /// A thread of another pool takes pieces of every run() until release(). It keeps its number there, which
  /// must be below threads() and not the one of the thread that calls run().
  void help();
  /// Lets all helpers go, and those that come until admit().
  void release();
  void admit() { released_ = false; }

 private:
  Workers() = default;
  void run_with_helpers(std::size_t pieces, const std::function<void(std::size_t)>& task);
  void take_tickets();
  void work(unsigned index);
  void take_pieces();
  void start_threads();
  void revive();

  unsigned threads_ = 1;
  bool helped_ = false;
  std::uint64_t forks_ = 0;  // of the process that the threads are in
  std::vector<std::jthread> others_;
  const std::function<void(std::size_t)>* task_ = nullptr;
  bool flush_ = false;  // denormal numbers in tasks, as on the thread that calls run()
  std::size_t pieces_ = 0;
  std::atomic<std::size_t> next_ = 0;        // piece to take
  std::atomic<std::uint32_t> round_ = 0;     // counts calls of run()
  std::atomic<std::uint32_t> finished_ = 0;  // other threads that are done with this round
  std::atomic<bool> ending_ = false;
  // With helpers, who come and go: the number of pieces in the upper half, the next one in the lower. A
  // ticket says by itself whether there was a piece left.
  std::atomic<std::uint64_t> tickets_ = 0;
  std::atomic<std::uint32_t> left_ = 0;  // pieces that are not done
  std::atomic<bool> released_ = false;
};

/// This process's share of the processors (sched_getaffinity), ≥ 1.
unsigned own_processors();
/// Threads this process may run at once: ASPIC_THREADS where that is set, else
/// own_processors(). Error (usage): ASPIC_THREADS is not a whole number from 1 to 1024.
Result<unsigned> available_threads();

}  // namespace aspic::parallel
