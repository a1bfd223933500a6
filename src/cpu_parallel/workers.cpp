#include "cpu_parallel/workers.h"

#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "base/flush_denormals.h"
#include "base/fork.h"
#include "base/printable.h"

namespace aspic::parallel {
namespace {

/// Looks at a value before a thread goes to sleep over it: a few microseconds, less than waking up takes.
constexpr int looks = 2000;

thread_local unsigned number_in_pool = 0;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Waits until `value` is no longer `old`.
void wait_while(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int n = 0; n < looks; ++n) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Workers::Workers(unsigned threads) : threads_(threads) {
  start_threads();
}

void Workers::start_threads() {
  forks_ = forks();
  for (unsigned n = 1; n < threads_; ++n) others_.emplace_back([this, n] { work(n); });
}

/// In a child of fork() there are no threads but the caller's: starts others, and leaves those that only the
/// parent has where nobody joins them.
void Workers::revive() {
  if (others_.empty() || forks_ == forks()) return;
  new std::vector<std::jthread>(std::move(others_));
  others_.clear();
  round_ = 0;
  finished_ = 0;
  if (!ending_) start_threads();
}

std::shared_ptr<Workers> Workers::of_helpers(unsigned threads) {
  std::shared_ptr<Workers> workers(new Workers);
  workers->threads_ = threads;
  workers->helped_ = true;
  return workers;
}

Workers::~Workers() {
  ending_ = true;
  revive();
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::run(std::size_t pieces, const std::function<void(std::size_t)>& task) {
  if (helped_) return run_with_helpers(pieces, task);
  revive();
  flush_ = FlushDenormals::is_on();
  task_ = &task;
  pieces_ = pieces;
  next_.store(0, std::memory_order_relaxed);
  if (others_.empty() || pieces < 2) return take_pieces();
  finished_.store(0, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  take_pieces();
  const auto all = static_cast<std::uint32_t>(others_.size());
  for (std::uint32_t n = finished_.load(std::memory_order_acquire); n != all;
       n = finished_.load(std::memory_order_acquire))
    wait_while(finished_, n);
}

unsigned Workers::current_thread() {
  return number_in_pool;
}

void Workers::run_with_helpers(std::size_t pieces, const std::function<void(std::size_t)>& task) {
  flush_ = FlushDenormals::is_on();
  task_ = &task;
  left_.store(static_cast<std::uint32_t>(pieces), std::memory_order_relaxed);
  tickets_.store(std::uint64_t{pieces} << 32, std::memory_order_release);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  take_tickets();
  for (std::uint32_t n = left_.load(std::memory_order_acquire); n != 0;
       n = left_.load(std::memory_order_acquire))
    wait_while(left_, n);
}

void Workers::take_tickets() {
  for (;;) {
    const std::uint64_t ticket = tickets_.fetch_add(1, std::memory_order_acq_rel);
    const std::uint64_t n = ticket & 0xffffffff;
    if (n >= ticket >> 32) return;  // also a ticket of a run that is over: its task is not touched
    {
      const FlushDenormals flush(flush_);
      (*task_)(n);
    }
    left_.fetch_sub(1, std::memory_order_acq_rel);
    left_.notify_one();
  }
}

void Workers::help() {
  for (;;) {
    const std::uint32_t round = round_.load(std::memory_order_acquire);
    if (released_) return;
    take_tickets();
    wait_while(round_, round);
  }
}

void Workers::release() {
  released_ = true;
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
}

void Workers::take_pieces() {
  const FlushDenormals flush(flush_);
  for (std::size_t n = next_.fetch_add(1, std::memory_order_relaxed); n < pieces_;
       n = next_.fetch_add(1, std::memory_order_relaxed))
    (*task_)(n);
}

void Workers::work(unsigned index) {
  number_in_pool = index;
  for (std::uint32_t round = 0;;) {
    wait_while(round_, round);
    ++round;
    if (ending_) return;
    take_pieces();
    finished_.fetch_add(1, std::memory_order_release);
    finished_.notify_one();
  }
}

Result<unsigned> available_threads() {
  if (const char* const text = std::getenv("ASPIC_THREADS")) {
    const std::string_view word = text;
    unsigned asked = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), asked);
    if (error == std::errc{} && end == word.data() + word.size() && asked >= 1 && asked <= 1024) return asked;
    return fail(
        ErrorCode::usage,
        "ASPIC_THREADS is \"{}\", which is not a number of threads: set a whole number from 1 to 1024, "
        "or unset it.",
        printable_line(word));
  }
  return own_processors();
}

unsigned own_processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    return std::max(1u, static_cast<unsigned>(CPU_COUNT(&set)));
  return std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace aspic::parallel
