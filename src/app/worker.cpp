#include "app/worker.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <cassert>
#include <utility>

namespace aspic::app {

Worker::Worker() : thread_([this] { loop(); }) {}

Worker::~Worker() {
  finish();
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::start(Job job) {
  {
    const std::lock_guard lock(mutex_);
    assert(!busy_);
    job_ = std::move(job);
    busy_ = true;
    hurry_ = false;
  }
  changed_.notify_all();
}

bool Worker::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

void Worker::finish() {
  hurry_ = true;
  wait();
}

void Worker::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_; });
}

void Worker::loop() {
  // Pictures and events go first. Where there is no such call all threads are equal, as they are by default.
#ifdef __linux__
  setpriority(PRIO_PROCESS, 0, 5);  // of this thread: POSIX says process, Linux means thread
#endif
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return busy_ || end_; });
    if (!busy_) return;
    lock.unlock();
    job_(hurry_);
    lock.lock();
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace aspic::app
