#include "playback/pull_log.h"

#include <algorithm>

namespace aspic {

void PullLog::set(std::uint64_t step, const std::optional<Pull>& pull) {
  forget_from(step);
  entries_.push_back({step, pull});
}

void PullLog::forget_from(std::uint64_t step) {
  while (!entries_.empty() && entries_.back().step >= step) entries_.pop_back();
}

std::optional<Pull> PullLog::at(std::uint64_t step) const {
  const auto later = std::ranges::upper_bound(entries_, step, {}, &Entry::step);
  return later == entries_.begin() ? std::nullopt : (later - 1)->pull;
}

std::optional<std::uint64_t> PullLog::next_change(std::uint64_t step) const {
  const auto later = std::ranges::upper_bound(entries_, step, {}, &Entry::step);
  if (later == entries_.end()) return std::nullopt;
  return later->step;
}

}  // namespace aspic
