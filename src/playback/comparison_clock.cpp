#include "playback/comparison_clock.h"

#include <algorithm>
#include <iterator>

namespace aspic {

/// The first that did not diverge.
VariantRun* ComparisonClock::stand_in() const {
  const auto found = std::ranges::find_if(
      runs_.variants, [](const auto& variant) { return !variant->simulation().divergence(); });
  return found == runs_.variants.end() ? nullptr : found->get();
}

const PlaybackSession& ComparisonClock::setter() const {
  return others_go_on() ? stand_in()->simulation() : runs_.leader;
}

bool ComparisonClock::toggle() {
  if (!others_go_on()) return false;
  others_run_ = !others_run_;
  recalled_.reset();
  return true;
}

double ComparisonClock::time() const {
  if (!runs_.several) return runs_.leader.time();
  const PlaybackSession& run = setter();
  for (std::size_t i = 0; i < runs_.count(); ++i)
    if (&runs_.run(i) == &run) return runs_.shown_time(i);
  return runs_.leader.time();
}

bool ComparisonClock::is_shown() const {
  if (!runs_.several) return true;
  if (!runs_.settled || runs_.shown.size() != runs_.count()) return false;
  const PlaybackSession& run = setter();
  for (std::size_t i = 0; i < runs_.count(); ++i)
    if (&runs_.run(i) == &run) return runs_.shown[i].time == run.time();
  return false;
}

void ComparisonClock::limit(Hold source, std::optional<std::uint64_t> step) {
  runs_.leader.pacer().limit(source, std::nullopt);
  for (const auto& variant : runs_.variants) variant->simulation().pacer().limit(source, std::nullopt);
  (others_go_on() ? stand_in()->simulation() : runs_.leader).pacer().limit(source, step);
}

double ComparisonClock::end_time() const {
  const auto end_of = [](const PlaybackSession& s) {
    const History& history = s.playback().history();
    return history.time(history.end_moment());
  };
  if (runs_.several && runs()) return time();
  double end = end_of(runs_.leader);
  if (!runs_.leader.playback().ends_diverged()) return end;
  for (const auto& variant : runs_.variants) end = std::max(end, end_of(variant->simulation()));
  return end;
}

Result<bool> ComparisonClock::go_to(double time) {
  Playback& own = runs_.leader.playback();
  const Moment last = own.history().end_moment();
  const double end = own.history().time(last);
  recalled_.reset();
  const bool beyond = time > end + 0.5 * runs_.leader.model().simulation.timestep;
  if (runs_.variants.empty() || !own.ends_diverged() || !beyond || !(end_time() > end)) return false;
  // The leader stays at its end, or goes there.
  others_run_ = false;
  recalled_ = time;
  if (own.here() != last) ASPIC_CHECK(own.seek(last));
  return true;
}

double ComparisonClock::real_time_factor() const {
  return runs_.several ? factor_ : aspic::real_time_factor(runs_.leader);
}

double ComparisonClock::figures_time() const {
  double limit = time();
  for (std::size_t i = 0; i < runs_.count(); ++i) {
    const PlaybackSession& run = runs_.run(i);
    const auto& energies = run.samples().energies();
    const double half = 0.5 * run.model().simulation.timestep;
    if (!run.divergence() && !energies.empty()) limit = std::min(limit, energies.back().time + half);
  }
  const auto& energies = setter().samples().energies();
  const auto after = std::ranges::upper_bound(energies, limit, {}, &EnergySample::time);
  return after == energies.begin() ? limit : std::prev(after)->time;
}

VariantRun* ComparisonClock::begin_frame(double dt) {
  measure(dt);
  const PlaybackSession& leader = runs_.leader;
  VariantRun* const ahead = leader.divergence() ? stand_in() : nullptr;
  // They go on where the leader did.
  if (ahead && was_running_) others_run_ = true;
  if (!ahead) others_run_ = false;
  was_running_ = leader.running();
  if (!leader.divergence() && !leader.playback().seeking()) recalled_.reset();
  return ahead;
}

/// Of what was shown since the last measurement, where something was.
void ComparisonClock::measure(double dt) {
  constexpr double window = 0.5;  // s
  const double now = time();
  measured_for_ += dt;
  if (!runs() || now < measured_from_) {
    factor_ = measured_for_ = 0.0;
    measured_from_ = now;
  } else if (measured_for_ > window && now > measured_from_) {
    factor_ = (now - measured_from_) / measured_for_;
    measured_for_ = 0.0;
    measured_from_ = now;
  }
}

}  // namespace aspic
