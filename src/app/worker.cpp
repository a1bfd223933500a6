#include "app/worker.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <cassert>
#include <utility>

namespace aspic::app {

Worker::Worker() : thread_([this] { loop(); }) {}

void Worker::abandon() noexcept {
  hurry_ = true;
  await_end();
}

Worker::~Worker() {
  abandon();
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::start(Job job) {
  rethrow();
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
  await_end();
  rethrow();
}

void Worker::rethrow() {
  std::exception_ptr failure;
  {
    const std::lock_guard lock(mutex_);
    failure = std::exchange(failure_, nullptr);
  }
  if (failure) std::rethrow_exception(failure);
}

void Worker::await_end() {
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
    std::exception_ptr failure;
    try {
      job_(hurry_);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace aspic::app
