#include "playback/jobs.h"

#include <cassert>
#include <utility>

#include "base/stopwatch.h"

namespace aspic {

void Jobs::start(Job job) {
  if (!busy()) progress_ = std::chrono::steady_clock::now();
  worker_.start(
      [this, job = std::move(job)](const std::atomic<bool>& canceled) { results_.put(job(canceled)); });
}

void Jobs::start_uncanceled(Job job) {
  assert(idle());
  uncanceled_ = true;
  start(std::move(job));
}

Status Jobs::collect() {
  if (!busy()) worker_.wait();  // for an exception
  while (const auto take_up = results_.take()) {
    progress_ = std::chrono::steady_clock::now();
    uncanceled_ = false;
    ASPIC_CHECK((*take_up)());
  }
  return {};
}

void Jobs::cancel() {
  if (!uncanceled_) worker_.cancel();
}

bool Jobs::long_under_way() const {
  constexpr double noticeable = 0.5;  // s
  return busy() && !has_news() && seconds_since(progress_) > noticeable;
}

}  // namespace aspic
