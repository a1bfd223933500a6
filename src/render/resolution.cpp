#include "render/resolution.h"

#include <algorithm>
#include <cassert>

namespace aspic {
namespace {

/// A finer share is taken up only with room to spare, so that it is not left again at once.
constexpr double room = 0.85;
/// Images after which a share's time is forgotten: what was slow once, as shaders were compiled or the
/// machine was busy, is tried again where the others leave hope.
constexpr int oldest = 60;
/// Images before a finer share is taken up again.
constexpr int patience = 200;

double pixels(std::size_t i) {
  return Resolution::shares[i] * Resolution::shares[i];
}

}  // namespace

void Resolution::took(double share, double seconds, double time) {
  const auto found = std::ranges::find(shares, share);
  assert(found != shares.end());
  const auto at = static_cast<std::size_t>(found - shares.begin());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (++ages_[i] > oldest) times_[i].reset();
  }
  ages_[at] = 0;
  if (std::optional<double>& known = times_[at]) {
    // One slow image among many may have been the machine's fault. If it was not, the others are slower
    // too.
    const double ratio = 0.6 + 0.4 * std::min(seconds / *known, 2.0);
    for (auto& of_share : times_) {
      if (of_share) *of_share *= ratio;
    }
  } else {
    known = seconds;
  }
  patience_ = std::max(patience_ - 1, 0);
  const std::size_t wanted = choose(time, chosen_);
  slow_ = wanted > chosen_ ? slow_ + 1 : 0;
  if (slow_ > 1)
    patience_ = patience;
  else if (wanted > chosen_ || patience_ > 0)
    return;
  slow_ = 0;
  chosen_ = wanted;
}

void Resolution::reset(bool large) {
  times_ = {};
  chosen_ = large ? shares.size() - 1 : 0;
  slow_ = patience_ = 0;
}

/// Time of an image at shares[i]; at least one share is known.
double Resolution::guess(std::size_t i) const {
  if (times_[i]) return *times_[i];
  std::optional<std::size_t> finest, next;
  for (std::size_t j = 0; j < shares.size() && !next; ++j) {
    if (times_[j]) (finest ? next : finest) = j;
  }
  // Coarser than a known one: no longer than that.
  if (i > *finest) return *times_[*finest];
  if (!next) return *times_[*finest] * pixels(i) / pixels(*finest);
  const double slope = (*times_[*finest] - *times_[*next]) / (pixels(*finest) - pixels(*next));
  return *times_[*finest] + std::max(slope, 0.0) * (pixels(i) - pixels(*finest));
}

std::size_t Resolution::choose(double time, std::size_t now) const {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (guess(i) <= (i < now ? room * time : time)) return i;
  }
  return shares.size() - 1;
}

}  // namespace aspic
