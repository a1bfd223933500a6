#include "gpu/pass_profiler.h"

#include <glad/gl.h>

#include <cassert>
#include <ctime>
#include <utility>

namespace aspic::gl {

PassProfiler::PassProfiler(Context& context, std::vector<std::string> names, PassStamps stamps)
    : context_(context), names_(std::move(names)), stamps_(stamps) {}

PassProfiler::~PassProfiler() {
  for (const Sample& sample : samples_)
    for (const std::uint32_t query : sample.queries)
      context_.dispose(query, [](std::uint32_t id) { glDeleteQueries(1, &id); });
}

void PassProfiler::stamp(Sample& sample, std::size_t index) {
  if (stamps_ == PassStamps::waiting) {
    glFinish();
    sample.host_times.push_back({std::chrono::steady_clock::now(), std::clock()});
    return;
  }
  if (index == sample.queries.size()) {
    sample.queries.push_back(0);
    glGenQueries(1, &sample.queries.back());
  }
  glQueryCounter(sample.queries[index], GL_TIMESTAMP);
}

bool PassProfiler::arrived(const Sample& sample) const {
  if (stamps_ == PassStamps::waiting) return true;
  GLint available = 0;
  glGetQueryObjectiv(sample.queries[sample.kinds.size()], GL_QUERY_RESULT_AVAILABLE, &available);
  return available != 0;
}

PassProfiler::Sum PassProfiler::interval(const Sample& sample, std::size_t index) const {
  if (stamps_ == PassStamps::waiting) {
    const HostTime &from = sample.host_times[index], &to = sample.host_times[index + 1];
    const auto took = std::chrono::duration_cast<std::chrono::nanoseconds>(to.time - from.time);
    return {static_cast<std::uint64_t>(took.count()), 1,
            static_cast<double>(to.processor - from.processor) / CLOCKS_PER_SEC};
  }
  GLuint64 before = 0, after = 0;
  glGetQueryObjectui64v(sample.queries[index], GL_QUERY_RESULT, &before);
  glGetQueryObjectui64v(sample.queries[index + 1], GL_QUERY_RESULT, &after);
  return {after >= before ? after - before : 0, 1, 0.0};
}

bool PassProfiler::begin() {
  measuring_ = false;
  collect();
  if (pending_ == samples_.size()) return false;
  Sample& sample = samples_[(first_ + pending_) % samples_.size()];
  sample.kinds.clear();
  sample.host_times.clear();
  stamp(sample, 0);
  measuring_ = true;
  return true;
}

void PassProfiler::mark(std::size_t kind) {
  assert(kind < names_.size());
  if (!measuring_) return;
  Sample& sample = samples_[(first_ + pending_) % samples_.size()];
  if (sample.kinds.size() == most_dispatches) {
    measuring_ = false;
    return;
  }
  sample.kinds.push_back(kind);
  stamp(sample, sample.kinds.size());
}

void PassProfiler::end() {
  if (!measuring_) return;
  measuring_ = false;
  ++pending_;
}

void PassProfiler::collect() {
  while (pending_ > 0) {
    const Sample& sample = samples_[first_];
    if (!arrived(sample)) return;
    std::vector<Sum> step(names_.size());
    for (std::size_t i = 0; i < sample.kinds.size(); ++i) step[sample.kinds[i]].add(interval(sample, i));
    steps_.push_back(std::move(step));
    if (steps_.size() > window) steps_.pop_front();
    first_ = (first_ + 1) % samples_.size();
    --pending_;
  }
}

std::vector<PassTime> PassProfiler::times() {
  collect();
  std::vector<PassTime> times;
  const auto count = static_cast<double>(steps_.size());
  for (std::size_t kind = 0; kind < names_.size(); ++kind) {
    Sum sum;
    for (const std::vector<Sum>& step : steps_) sum.add(step[kind]);
    if (sum.dispatches == 0) continue;
    times.push_back({names_[kind], 1e-6 * static_cast<double>(sum.nanoseconds) / count,
                     static_cast<double>(sum.dispatches) / count, 1e3 * sum.processor_seconds / count});
  }
  return times;
}

}  // namespace aspic::gl
