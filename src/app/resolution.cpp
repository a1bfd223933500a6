#include "app/resolution.h"

#include <algorithm>

namespace aspic::app {
namespace {

/// Few shares, so that pictures do not swim; each has about half the pixels of the one before.
constexpr double shares[] = {1.0, 0.75, 0.55, 0.4, Resolution::coarsest};
/// A finer share is taken up only with room to spare, so that it is not left again at once.
constexpr double room = 0.8;

}  // namespace

void Resolution::took(double share, double seconds) {
  const double cost = seconds / (share * share);
  // One slow picture among many may have been the machine's fault.
  cost_ = cost_ && share == last_ ? 0.6 * *cost_ + 0.4 * cost : cost;
  last_ = share;
  moving_ = choose(in_motion, moving_);
  still_ = std::max(choose(at_rest, still_), moving_);
}

void Resolution::reset(bool large) {
  cost_.reset();
  last_ = 0.0;
  moving_ = still_ = large ? coarsest : 1.0;
}

double Resolution::choose(double time, double now) const {
  for (const double share : shares) {
    const double guess = *cost_ * share * share;
    if (guess <= (share > now ? room * time : time)) return share;
  }
  return coarsest;
}

}  // namespace aspic::app
