#include "run/recording.h"

#include <algorithm>
#include <chrono>
#include <new>

#include "base/stopwatch.h"
#include "gpu/current.h"

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

/// Most bytes of frames that wait for the encoder: little next to a simulation.
constexpr std::size_t most_waiting_bytes = std::size_t{128} << 20;

}  // namespace

Result<std::unique_ptr<Recording>> Recording::start(gl::Context& context,
                                                    std::vector<std::unique_ptr<FrameSink>> sinks,
                                                    VideoOptions options) {
  ASPIC_TRY(auto ring, gl::PixelRing::create(context, options.size.width, options.size.height));
  return std::unique_ptr<Recording>(
      new Recording(context, std::move(ring), std::move(sinks), std::move(options)));
}

Recording::Recording(gl::Context& context, gl::PixelRing ring, std::vector<std::unique_ptr<FrameSink>> sinks,
                     VideoOptions options)
    : context_(context), options_(std::move(options)), ring_(std::move(ring)), sinks_(std::move(sinks)) {
  const std::size_t bytes =
      3 * static_cast<std::size_t>(options_.size.width) * static_cast<std::size_t>(options_.size.height);
  most_waiting_ = std::clamp<std::size_t>(most_waiting_bytes / bytes, 2, 64);
  thread_ = std::thread([this] { encode(); });
}

Recording::~Recording() {
  abandon();
  thread_.join();
}

void Recording::abandon() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = abandoned_ || !ended_;
    ended_ = no_more_ = true;
  }
  changed_.notify_all();
}

bool Recording::ready() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size() < most_waiting_ || completed_;
}

void Recording::wait_until_ready() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < most_waiting_ || completed_; });
}

Status Recording::hand_on() {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  Frame frame;
  frame.copies = copies_.front();
  copies_.pop_front();
  const auto before = Clock::now();
  ASPIC_CHECK(ring_.take(frame.pixels));
  read_seconds_ += seconds_since(before);
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(frame));
  }
  changed_.notify_all();
  return {};
}

Status Recording::add(const gl::Framebuffer& frame, std::uint64_t copies) {
  const gl::Current here(context_);
  ASPIC_CHECK(here.status());
  if (ring_.full()) ASPIC_CHECK(hand_on());
  ring_.submit(frame);
  copies_.push_back(copies);
  frames_ += copies;
  return {};
}

Status Recording::progress() {
  return ring_.pending() > 0 ? hand_on() : Status();
}

void Recording::end() {
  if (ended_) return;
  ended_ = true;
  while (ring_.pending() > 0 && hand_on()) {
  }
  {
    const std::lock_guard lock(mutex_);
    no_more_ = true;
  }
  changed_.notify_all();
}

Status Recording::end_complete() {
  while (ring_.pending() > 0) {
    if (const Status read = hand_on(); !read) {
      abandon();
      return read;
    }
  }
  end();
  return {};
}

bool Recording::completed() const {
  const std::lock_guard lock(mutex_);
  return completed_;
}

Status Recording::result() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return completed_; });
  return failures_.empty() ? Status() : Status(failures_.front());
}

std::vector<Error> Recording::failures() const {
  const std::lock_guard lock(mutex_);
  return failures_;
}

std::vector<std::string> Recording::written() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return completed_; });
  return written_;
}

FrameTimes Recording::times() const {
  const std::lock_guard lock(mutex_);
  FrameTimes times;
  times.frames = frames_;
  times.read = read_seconds_;
  times.encode = encode_seconds_;
  return times;
}

/// What a sink does on the encoder's thread, where an exception would end the program. False: it is lost.
template <class Work>
bool Recording::carry_out(std::unique_ptr<FrameSink>& sink, const Work& work) {
  Status done;
  try {
    done = work(*sink);
  } catch (const std::bad_alloc&) {
    done = Error{ErrorCode::io, "Cannot write the video: not enough memory."};
  }
  if (done) return true;
  sink.reset();
  const std::lock_guard lock(mutex_);
  failures_.push_back(done.error());
  return false;
}

void Recording::write(const Frame& frame) {
  for (auto& sink : sinks_) {
    for (std::uint64_t i = 0; sink && i < frame.copies; ++i)
      carry_out(sink, [&](FrameSink& to) { return to.write(frame.pixels); });
  }
}

void Recording::encode() {
  const auto any_left = [this] {
    return std::ranges::any_of(sinks_, [](const auto& s) { return s != nullptr; });
  };
  std::unique_lock lock(mutex_);
  while (any_left()) {
    changed_.wait(lock, [this] { return !waiting_.empty() || no_more_; });
    if (abandoned_ || waiting_.empty()) break;
    Frame frame = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    changed_.notify_all();
    const auto before = Clock::now();
    write(frame);
    const double took = seconds_since(before);
    lock.lock();
    encode_seconds_ += took;
  }
  const bool complete = !abandoned_;
  lock.unlock();
  std::vector<std::string> written;
  for (auto& sink : sinks_) {
    if (!complete || !sink) continue;
    carry_out(sink, [&](FrameSink& to) -> Status {
      const std::string path = to.path();
      ASPIC_CHECK(to.finish());
      written.push_back(path);
      return {};
    });
  }
  sinks_.clear();
  lock.lock();
  waiting_.clear();
  written_ = std::move(written);
  completed_ = true;
  lock.unlock();
  changed_.notify_all();
}

}  // namespace aspic
