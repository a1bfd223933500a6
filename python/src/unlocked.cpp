#include "unlocked.h"

#include <pthread.h>

#include <chrono>
#include <thread>

namespace aspic::python {
namespace {

std::atomic<std::uint64_t> forks_so_far = 0;
[[maybe_unused]] const int counted = pthread_atfork(nullptr, nullptr, [] { ++forks_so_far; });

[[noreturn]] void stay() {
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

std::uint64_t forks() {
  return forks_so_far;
}

Unlocked::Unlocked() {
  ++threads_;
  state_ = PyEval_SaveThread();
  if (!ending_) return;
  --threads_;
  stay();
}

Unlocked::~Unlocked() {
  if (ending_) {
    --threads_;
    stay();
  }
  PyEval_RestoreThread(state_);
  --threads_;
}

void Unlocked::end() {
  ending_ = true;
  PyThreadState* const state = PyEval_SaveThread();
  for (int n = 0; threads_ > 0 && n < 500; ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  PyEval_RestoreThread(state);
}

}  // namespace aspic::python
