#include "gpu/pass_profiler.h"

#include <glad/gl.h>

#include <cassert>
#include <utility>

namespace aspic::gl {

PassProfiler::PassProfiler([[maybe_unused]] Context& context, std::vector<std::string> names)
    : names_(std::move(names)) {}

PassProfiler::~PassProfiler() {
  for (const Sample& sample : samples_)
    glDeleteQueries(static_cast<GLsizei>(sample.queries.size()), sample.queries.data());
}

void PassProfiler::stamp(Sample& sample, std::size_t index) {
  if (index == sample.queries.size()) {
    sample.queries.push_back(0);
    glGenQueries(1, &sample.queries.back());
  }
  glQueryCounter(sample.queries[index], GL_TIMESTAMP);
}

bool PassProfiler::begin() {
  measuring_ = false;
  collect();
  if (pending_ == samples_.size()) return false;
  Sample& sample = samples_[(first_ + pending_) % samples_.size()];
  sample.kinds.clear();
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
    GLint available = 0;
    glGetQueryObjectiv(sample.queries[sample.kinds.size()], GL_QUERY_RESULT_AVAILABLE, &available);
    if (!available) return;
    std::vector<Sum> step(names_.size());
    GLuint64 before = 0;
    glGetQueryObjectui64v(sample.queries[0], GL_QUERY_RESULT, &before);
    for (std::size_t i = 0; i < sample.kinds.size(); ++i) {
      GLuint64 after = 0;
      glGetQueryObjectui64v(sample.queries[i + 1], GL_QUERY_RESULT, &after);
      Sum& sum = step[sample.kinds[i]];
      sum.nanoseconds += after >= before ? after - before : 0;
      ++sum.dispatches;
      before = after;
    }
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
    for (const std::vector<Sum>& step : steps_) {
      sum.nanoseconds += step[kind].nanoseconds;
      sum.dispatches += step[kind].dispatches;
    }
    if (sum.dispatches == 0) continue;
    times.push_back({names_[kind], 1e-6 * static_cast<double>(sum.nanoseconds) / count,
                     static_cast<double>(sum.dispatches) / count});
  }
  return times;
}

}  // namespace aspic::gl
