#include "app/worker.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <cassert>
#include <chrono>
#include <utility>

namespace aspic::app {

void Worker::start(Job job) {
  assert(!busy());
  wait();
  hurry_ = false;
  job_ = std::async(std::launch::async, [this, run = std::move(job)] {
  // Pictures and events go first. Where there is no such call all threads are equal, as they are by default.
#ifdef __linux__
    setpriority(PRIO_PROCESS, 0, 5);  // of this thread: POSIX says process, Linux means thread
#endif
    run(hurry_);
  });
}

bool Worker::busy() const {
  return job_.valid() && job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void Worker::wait() {
  if (job_.valid()) job_.get();
}

void Worker::finish() {
  hurry_ = true;
  wait();
}

void Worker::abandon() noexcept {
  hurry_ = true;
  if (job_.valid()) job_.wait();
}

}  // namespace aspic::app
