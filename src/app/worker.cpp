#include "app/worker.h"

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
