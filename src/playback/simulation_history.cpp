// What moves a run through its history.
#include <algorithm>
#include <utility>

#include "base/stopwatch.h"
#include "playback/simulation.h"

namespace aspic {

Status Simulation::seek(const Moment& moment) {
  set_running(false);
  requested_.reset();
  worker_.finish();
  if (const Status taken = collect(); !taken) return fall_back(taken.error());
  const std::optional<std::uint64_t> underway = std::exchange(seek_, std::nullopt);
  if (moment == here() && !underway) return halt(true);
  if (divergence_ && at_end()) ended_ = {here(), *divergence_};
  const Keyframe& keyframe = history_.keyframe(moment);
  const bool on_the_way = moment.stretch == stretch_ && step_ <= moment.step && step_ >= keyframe.step;
  if (moment.stretch != stretch_) {
    const Setup setup = history_.stretch(moment.stretch).setup;
    ASPIC_CHECK(install(setup, factory_.make_like(engines_, setup)));
    stretch_ = moment.stretch;
  }
  if (!on_the_way) {
    // The newest state of a gpu may not have been kept yet: it is where a way back ends.
    ASPIC_CHECK(load(unpack(keyframe)));
  }
  divergence_.reset();
  seek_ = moment.step;
  return {};
}

Status Simulation::replay(History history) {
  ASPIC_CHECK(halt(true));
  const Moment first = history.begin_moment();
  const Setup setup = history.stretch(first.stretch).setup;
  ASPIC_CHECK(install(setup, factory_.make_like(engines_, setup)));
  history_ = std::move(history);
  ended_.reset();
  samples_.clear();
  stretch_ = first.stretch;
  return load(unpack(history_.keyframe(first)));
}

Status Simulation::seek_on(double budget) {
  const auto start = Clock::now();
  while (seek_ && step_ < *seek_) {
    if (!idle()) return {};
    const auto pull = history_.pull_at(here());
    ASPIC_CHECK(engines_.set_pull(pull));
    const std::uint64_t stop = std::min(*seek_, history_.next_pull_change(here()).value_or(*seek_));
    if (!Engines::in_context(engines_.leader())) {
      start_job(stop, std::max(budget, shortest_job), true, pull);
      return {};
    }
    ASPIC_CHECK(advance_here(stop - step_, budget - seconds_since(start)));
    if (seconds_since(start) > 0.75 * budget) return {};
  }
  seek_.reset();
  ASPIC_CHECK(refresh_snapshot());
  arrive();
  return shadowed() ? engines_.shadow().solver->load(snapshot_) : Status();
}

/// At the end of a history that ended with a divergence there is no way on.
void Simulation::arrive() {
  if (ended_ && ended_->first == here() && at_end()) divergence_ = ended_->second;
}

Status Simulation::step_back() {
  const auto earlier = history_.before({stretch_, seek_.value_or(step_)});
  return earlier ? seek(*earlier) : Status();
}

}  // namespace aspic
