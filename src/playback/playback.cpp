#include "playback/playback.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "base/stopwatch.h"

namespace aspic {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();  // s

}  // namespace

Status Playback::seek(const Moment& moment) {
  ++seeks_;
  stepper_.set_running(false);
  jobs_.finish();
  if (const Status taken = jobs_.collect(); !taken) return stepper_.fall_back(taken.error());
  const bool underway = timeline_.seeking();
  timeline_.stop();
  if (moment == here() && !underway) return halt(true);
  timeline_.remember_end();
  const Keyframe& keyframe = history().keyframe(moment);
  const bool on_the_way =
      moment.stretch == here().stretch && present_.step() <= moment.step && present_.step() >= keyframe.step;
  if (moment.stretch != here().stretch) {
    const Setup setup = history().stretch(moment.stretch).setup;
    ASPIC_CHECK(stepper_.install(setup, factory_.make_like(present_.engines(), setup)));
    timeline_.move_to(moment.stretch);
  }
  if (!on_the_way) {
    // The newest state of a gpu may not have been kept yet: it is where a way back ends.
    ASPIC_CHECK(stepper_.load(unpack(keyframe)));
  }
  present_.set_divergence(std::nullopt);
  timeline_.set_out(moment.step);
  return {};
}

Status Playback::replay(History history) {
  ASPIC_CHECK(halt(true));
  const Moment first = history.begin_moment();
  const Setup setup = history.stretch(first.stretch).setup;
  ASPIC_CHECK(stepper_.install(setup, factory_.make_like(present_.engines(), setup)));
  timeline_.replace(std::move(history));
  figures_.samples().clear();
  return stepper_.load(unpack(timeline_.history().keyframe(first)));
}

Status Playback::go_on(double budget) {
  const auto start = std::chrono::steady_clock::now();
  while (timeline_.seeking() && present_.step() < *timeline_.destination()) {
    if (!jobs_.idle()) return {};
    const std::uint64_t destination = *timeline_.destination();
    const std::uint64_t stop =
        std::min(destination, history().next_input_change(here()).value_or(destination));
    ASPIC_CHECK(stepper_.repeat_to(stop, budget - seconds_since(start), history().inputs_at(here())));
    if (!Engines::in_context(present_.engines().leader())) return {};
    if (seconds_since(start) > 0.75 * budget) return {};
  }
  timeline_.stop();
  ASPIC_CHECK(stepper_.refresh_snapshot());
  // At the end of a history that ended with a divergence there is no way on.
  if (const auto end = timeline_.end()) present_.set_divergence(end);
  const Engines& engines = present_.engines();
  return engines.shadowed() ? engines.shadow().solver->load(present_.snapshot()) : Status();
}

std::optional<Moment> Playback::earlier() const {
  return history().before({here().stretch, timeline_.destination().value_or(present_.step())});
}

Status Playback::step_back() {
  const auto moment = earlier();
  return moment ? seek(*moment) : Status();
}

Status Playback::step_singly() {
  if (!jobs_.idle()) return {};
  if (const auto next = history().after(here())) {
    stepper_.single_step_done();
    return seek(*next);
  }
  return stepper_.advance_to(present_.step() + 1, endless);
}

Status Playback::halt(bool arrive) {
  jobs_.finish();
  Status moved = jobs_.collect();
  while (arrive && moved && timeline_.seeking()) {
    moved = go_on(endless);
    jobs_.wait();
    if (moved) moved = jobs_.collect();
  }
  return moved ? stepper_.refresh_snapshot() : stepper_.fall_back(moved.error());
}

Status Playback::settle() {
  ASPIC_CHECK(halt(true));
  while (stepper_.single_steps() > 0 && !present_.divergence()) {
    ASPIC_CHECK(step_singly());
    jobs_.wait();
    ASPIC_CHECK(halt(true));
  }
  return {};
}

}  // namespace aspic
