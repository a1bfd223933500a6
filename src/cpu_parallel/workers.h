#pragma once
// Threads that share the pieces of a task. A pool of our own, since a step of a small cube takes 10 µs: a
// general scheduler's start and end would take as long.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "base/result.h"

namespace aspic::parallel {

class Workers {
 public:
  /// `threads` ≥ 1, the caller's own among them.
  explicit Workers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const { return static_cast<unsigned>(others_.size()) + 1; }
  /// Which of them a task runs on, from 0.
  static unsigned current();

  /// Calls task(n) for every n below `pieces`, in any order and on any thread, and returns when all are done.
  /// What the pieces wrote is visible then. The task must not throw.
  void run(std::size_t pieces, const std::function<void(std::size_t)>& task);

 private:
  void work(unsigned index);
  void take_pieces();

  std::vector<std::jthread> others_;
  const std::function<void(std::size_t)>* task_ = nullptr;
  std::size_t pieces_ = 0;
  std::atomic<std::size_t> next_ = 0;        // piece to take
  std::atomic<std::uint32_t> round_ = 0;     // counts calls of run()
  std::atomic<std::uint32_t> finished_ = 0;  // other threads that are done with this round
  std::atomic<bool> ending_ = false;
};

/// This process's share of the processors (sched_getaffinity), ≥ 1.
unsigned own_processors();
/// Threads this process may run at once: ASPIC_THREADS where that is set, else
/// own_processors(). Error (usage): ASPIC_THREADS is not a whole number from 1 to 1024.
Result<unsigned> available_threads();

}  // namespace aspic::parallel
