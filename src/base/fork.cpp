#include "base/fork.h"

#include <pthread.h>

#include <atomic>

namespace aspic {
namespace {

std::atomic<std::uint64_t> count = 0;
[[maybe_unused]] const int registered = pthread_atfork(nullptr, nullptr, [] { ++count; });

}  // namespace

std::uint64_t forks() {
  return count.load(std::memory_order_relaxed);
}

}  // namespace aspic
