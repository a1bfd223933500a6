#include "playback/samples.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "aspic/analysis.h"

namespace aspic {
namespace {

constexpr std::size_t most_differences = 2000;

/// Seconds between the samples of a run.
constexpr double interval = 0.02;

/// The quantities whose extremes stay where samples are thinned.
constexpr double (*quantities[])(const EnergySample&) = {
    [](const EnergySample& s) { return s.measures.kinetic; },
    [](const EnergySample& s) { return s.measures.elastic; },
    [](const EnergySample& s) { return s.measures.gravitational; },
    [](const EnergySample& s) { return s.measures.total(); },
    [](const EnergySample& s) { return s.measures.contact.value_or(0.0); },
    [](const EnergySample& s) { return s.work.value_or(0.0); },
    [](const EnergySample& s) { return s.measures.momentum.x; },
    [](const EnergySample& s) { return s.measures.momentum.y; },
    [](const EnergySample& s) { return s.measures.momentum.z; },
    [](const EnergySample& s) { return length(s.measures.momentum); },
    [](const EnergySample& s) { return s.measures.max_speed; },
    [](const EnergySample& s) { return s.measures.min_height; }};
/// Two of each quantity stay, so that half of the samples go at least.
constexpr std::size_t most_intervals = Samples::most_energies / (4 * std::size(quantities));

}  // namespace

std::uint64_t next_sample_step(std::uint64_t step, double timestep, std::uint64_t stride) {
  const double apart = interval < 2.0 * timestep ? 1.0 : interval / timestep;
  const double steps = std::min(apart * static_cast<double>(stride), 0x1p62);
  // Beyond what a double counts in ones.
  if (step >> 52 != 0) return step + static_cast<std::uint64_t>(std::round(steps));
  double next = std::floor(static_cast<double>(step) / steps);
  while (std::round(next * steps) <= static_cast<double>(step)) ++next;
  return static_cast<std::uint64_t>(std::round(next * steps));
}

const EnergySample* Samples::nearest(double time) const {
  const auto after = std::ranges::lower_bound(energies_, time, {}, &EnergySample::time);
  if (after == energies_.begin()) return energies_.empty() ? nullptr : &*after;
  const auto before = after - 1;
  return after == energies_.end() || time - before->time < after->time - time ? &*before : &*after;
}

void Samples::add(const EnergySample& sample) {
  auto place = std::ranges::lower_bound(energies_, sample.time, {}, &EnergySample::time);
  if (place != energies_.end() && place->time == sample.time)
    *place = sample;
  else
    place = energies_.insert(place, sample);
  add_up_work(static_cast<std::size_t>(place - energies_.begin()));
  if (energies_.size() > most_energies) thin();
}

void Samples::thin() {
  double width = interval;
  // Of twice the length each time: what stayed in short intervals holds the extremes of long ones.
  while ((energies_.back().time - energies_.front().time) / width > static_cast<double>(most_intervals))
    width *= 2.0;
  const auto interval_of = [&](const EnergySample& s) { return std::floor(s.time / width); };
  std::deque<EnergySample> kept;
  std::vector<std::size_t> stay;
  for (std::size_t from = 0, to = 0; from < energies_.size(); from = to) {
    while (to < energies_.size() && interval_of(energies_[to]) == interval_of(energies_[from])) ++to;
    stay.clear();
    if (from == 0) stay.push_back(0);
    if (to == energies_.size()) stay.push_back(to - 1);
    for (const auto quantity : quantities) {
      const auto [least, most] =
          std::minmax_element(energies_.begin() + static_cast<std::ptrdiff_t>(from),
                              energies_.begin() + static_cast<std::ptrdiff_t>(to),
                              [&](const auto& a, const auto& b) { return quantity(a) < quantity(b); });
      for (const auto& at : {least, most}) stay.push_back(static_cast<std::size_t>(at - energies_.begin()));
    }
    std::ranges::sort(stay);
    stay.erase(std::unique(stay.begin(), stay.end()), stay.end());
    for (const std::size_t n : stay) kept.push_back(energies_[n]);
  }
  energies_ = std::move(kept);
}

/// Works out the sum at a sample that is new, and shifts those after it: what they add does not change.
void Samples::add_up_work(std::size_t from) {
  const auto between = [&](std::size_t n) {
    ActuatorWork work = energies_[n - 1].actuators;
    return work.append(energies_[n].actuators);
  };
  const auto sum = [&](std::size_t n) -> std::optional<double> {
    if (n == 0) return ActuatorWork().append(energies_[0].actuators);
    const auto added = between(n);
    return added ? std::optional(energies_[n - 1].work.value_or(0.0) + *added) : std::nullopt;
  };
  energies_[from].work = sum(from);
  if (from + 1 == energies_.size()) return;
  const double was = energies_[from + 1].work.value_or(0.0);
  energies_[from + 1].work = sum(from + 1);
  const double more = energies_[from + 1].work.value_or(0.0) - was;
  for (std::size_t n = from + 2; n < energies_.size(); ++n)
    if (energies_[n].work) *energies_[n].work += more;
}

void Samples::compare(double time, const State& leader, const State& shadow, bool one_diverged) {
  DifferenceSample sample;
  sample.time = time;
  const auto difference = compare_states(leader, shadow);
  if (difference && leader.step == shadow.step && !one_diverged) {
    sample.meters = std::max(difference->position.absolute, difference->ball_position.absolute);
    sample.ulp = std::max({difference->position.ulp, difference->velocity.ulp, difference->ball_position.ulp,
                           difference->ball_velocity.ulp, difference->ball_angular_velocity.ulp});
    sample.identical = difference->identical();
  } else {
    sample.meters = std::numeric_limits<double>::infinity();
  }
  ever_differed_ = ever_differed_ || !sample.identical;
  while (!differences_.empty() && differences_.back().time >= time) differences_.pop_back();
  differences_.push_back(sample);
  if (differences_.size() > most_differences) differences_.pop_front();
}

void Samples::truncate(double time) {
  while (!energies_.empty() && energies_.back().time > time) energies_.pop_back();
  while (!differences_.empty() && differences_.back().time > time) differences_.pop_back();
}

void Samples::clear_differences() {
  differences_.clear();
  ever_differed_ = false;
}

void Samples::clear() {
  energies_.clear();
  clear_differences();
}

}  // namespace aspic
