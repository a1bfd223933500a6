#include "gpu/timer.h"

#include <glad/gl.h>

#include <cassert>

namespace aspic::gl {

Timer::Timer([[maybe_unused]] Context& context) {
  assert(!context.lost());
  for (auto& pair : queries_) glGenQueries(2, pair.data());
}

Timer::~Timer() {
  for (auto& pair : queries_) glDeleteQueries(2, pair.data());
}

bool Timer::begin() {
  assert(!running_);
  if (pending_ == capacity) return false;
  glQueryCounter(queries_[(first_ + pending_) % capacity][0], GL_TIMESTAMP);
  running_ = true;
  return true;
}

void Timer::end() {
  if (!running_) return;
  glQueryCounter(queries_[(first_ + pending_) % capacity][1], GL_TIMESTAMP);
  running_ = false;
  ++pending_;
}

std::uint64_t Timer::take() {
  GLuint64 start = 0;
  GLuint64 stop = 0;
  glGetQueryObjectui64v(queries_[first_][0], GL_QUERY_RESULT, &start);
  glGetQueryObjectui64v(queries_[first_][1], GL_QUERY_RESULT, &stop);
  first_ = (first_ + 1) % capacity;
  --pending_;
  return stop >= start ? stop - start : 0;
}

std::optional<std::uint64_t> Timer::poll() {
  if (pending_ == 0) return std::nullopt;
  GLint available = 0;
  glGetQueryObjectiv(queries_[first_][1], GL_QUERY_RESULT_AVAILABLE, &available);
  if (!available) return std::nullopt;
  return take();
}

std::optional<std::uint64_t> Timer::wait() {
  if (pending_ == 0) return std::nullopt;
  return take();
}

}  // namespace aspic::gl
