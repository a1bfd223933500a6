#include "playback/timeline.h"

#include <algorithm>

#include "base/stopwatch.h"

namespace aspic {
namespace {

constexpr std::uint64_t most_history_bytes = std::uint64_t{512} << 20;
/// Keyframes are this far apart in running time, farther where memory would not hold the last half minute.
constexpr double keyframe_interval = 0.1, history_seconds = 30.0;  // s

}  // namespace

Timeline::Timeline(const Present& present) : present_(present), history_(most_history_bytes) {}

void Timeline::clear() {
  history_.clear();
  last_kept_ = {};
}

void Timeline::begin(const State& state, bool same) {
  ended_.reset();
  history_.begin(present_.setup(), state, same);
  stretch_ = history_.end_moment().stretch;
}

void Timeline::replace(History history) {
  history_ = std::move(history);
  ended_.reset();
  stretch_ = history_.begin_moment().stretch;
}

void Timeline::forget_future() {
  history_.truncate(here());
  ended_.reset();
}

void Timeline::remember_end() {
  if (present_.divergence() && at_end()) ended_ = {here(), *present_.divergence()};
}

std::optional<Divergence> Timeline::end() const {
  if (ended_ && ended_->first == here() && at_end()) return ended_->second;
  return std::nullopt;
}

void Timeline::keep(const State& state) {
  if (present_.divergence() || !at_end()) return;
  const double bytes = 24.0 * static_cast<double>(state.position.size());
  const double interval =
      std::max(keyframe_interval, history_seconds * bytes / static_cast<double>(history_.most_bytes()));
  if (seconds_since(last_kept_) < interval) return;
  last_kept_ = std::chrono::steady_clock::now();
  history_.add_keyframe(state);
}

}  // namespace aspic
