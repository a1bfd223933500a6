#include "playback/worker.h"

#ifdef __linux__
#include <sys/resource.h>
#endif

namespace aspic {

Worker::~Worker() {
  abandon();
  const std::scoped_lock lock(mutex_);
  ending_ = true;
  changed_.notify_all();
}

void Worker::start(Job job) {
  const std::scoped_lock lock(mutex_);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  if (!thread_.joinable()) thread_ = std::jthread([this] { work(); });
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Worker::work() {
  // Images and events go first. Where there is no such call all threads are equal, as they are by default.
#ifdef __linux__
  // Of this thread: POSIX says process, Linux means thread.
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + 5);
#endif
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (ending_) return;
    const Job job = std::move(jobs_.front());
    lock.unlock();
    std::exception_ptr thrown;
    try {
      job(canceled_);
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    if (thrown) thrown_ = thrown;
    canceled_ = false;
    jobs_.pop_front();
    changed_.notify_all();
  }
}

std::size_t Worker::jobs() const {
  const std::scoped_lock lock(mutex_);
  return jobs_.size();
}

void Worker::cancel() {
  const std::scoped_lock lock(mutex_);
  if (jobs_.empty()) return;
  canceled_ = true;
  jobs_.resize(1);
}

void Worker::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void Worker::finish() {
  cancel();
  wait();
}

void Worker::abandon() noexcept {
  cancel();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
}

}  // namespace aspic
