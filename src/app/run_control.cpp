#include "app/run_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

#include "analysis/stability.h"

namespace aspic::app {
namespace {

/// With a capital letter.
std::string sentence(std::string words) {
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words;
}

}  // namespace

void RunControl::toggle() {
  if (simulation_.divergence())
    messages_.error("The simulation has diverged. Use a smaller time step, go back or reset first.",
                    Until::divergence_is_over);
  else
    simulation_.set_running(!simulation_.running());
}

void RunControl::single_step() {
  if (simulation_.running()) simulation_.set_running(false);
  messages_.check(simulation_.single_step());
}

void RunControl::reset() {
  messages_.check(simulation_.rebuild().reset());
}

void RunControl::change_speed(double factor) {
  Pacer& pacer = simulation_.pacer();
  pacer.set_speed(pacer.speed() * factor);
}

void RunControl::switch_backend() {
  const BackendRow& current = simulation_.present().backend();
  const BackendRow* row = &next_backend(current);
  const Status first = simulation_.rebuild().set_backend(*row);
  Status changed = first;
  while (!changed && (row = &next_backend(*row)) != &current)
    changed = simulation_.rebuild().set_backend(*row);
  scene_.follow_history();
  const std::string now = fmt::format("Backend: {}.", simulation_.present().solver().description());
  if (first)
    messages_.info(now);
  else
    messages_.error(changed ? fail(first.error(), "{} {}", first.error().what, now) : first.error());
}

void RunControl::set_shadow(const BackendRow* backend) {
  if (!messages_.check(simulation_.rebuild().set_shadow(backend))) return;
  messages_.info(backend ? fmt::format("Comparing with {}.",
                                       simulation_.present().engines().shadow().solver->description())
                         : "The comparison of backends has ended.");
}

void RunControl::step_back() {
  if (!simulation_.playback().can_step_back()) return;
  messages_.check(simulation_.playback().step_back());
  scene_.follow_history();
}

void RunControl::go_to(double time) {
  messages_.check(simulation_.playback().seek(simulation_.playback().history().nearest(time)));
  scene_.follow_history();
}

void RunControl::back_before_divergence() {
  messages_.dismiss();
  messages_.check(simulation_.playback().seek(simulation_.playback().before_trouble()));
  scene_.follow_history();
}

std::optional<double> RunControl::offered_step() const {
  return stable_ ? step_to_try(simulation_.model().simulation.timestep, *stable_) : std::nullopt;
}

void RunControl::take_offered_step() {
  const auto step = offered_step();
  if (!step) return;
  messages_.dismiss();
  messages_.check(simulation_.playback().seek(simulation_.playback().before_trouble()));
  // The state of then, with the values of now.
  scene_.set_value(*find_parameter("simulation.timestep"), 0, Value(*step));
  scene_.hand_over();
}

void RunControl::watch_divergence() {
  const auto& divergence = simulation_.divergence();
  if (!divergence) {
    stable_.reset();
    messages_.divergence_is_over();
  }
  if (!divergence || stable_) return;
  const Model& model = simulation_.model();
  const SimulationSettings& s = model.simulation;
  stable_ = stability_limit(model, s.integrator, StabilityEffort::quick);
  messages_.error(
      fmt::format(
          "The simulation diverged in step {} (t = {:.6g} s): {} {}. {} The window shows the last good step.",
          divergence->step, static_cast<double>(divergence->step) * s.timestep, body_text(*divergence),
          fault_text(*divergence), divergence_sentence(s.timestep, s.integrator, *stable_)),
      Until::divergence_is_over);
}

void RunControl::watch_run() {
  const auto tell = [&](const std::vector<Diagnostic>& found) {
    std::string text;
    for (const Diagnostic& each : found) text += (text.empty() ? "" : " ") + sentence(each.sentence());
    if (!text.empty()) messages_.info(text, 15.0);
  };
  // While a change is on its way the scene is ahead of the model.
  if (scene_.pending() || simulation_.rebuild().changing() || simulation_.divergence()) return;
  const std::uint64_t number = simulation_.present().model_number(), step = simulation_.snapshot().step;
  const auto part = std::pair(simulation_.present().run_number(), simulation_.playback().here().stretch);
  if (!watch_ || watched_model_ != number) {
    const bool first = !watch_;
    RunWatch watch(scene_.scene().model, simulation_.model(), step == 0);
    // A constant that changes on the way is no news of what overlaps.
    if (!first && step > 0) watch.knows_what(*watch_);
    watch_ = std::move(watch);
    watched_model_ = number;
    watched_part_ = part;
    next_look_ = watch_->next_step(step);
    tell(watch_->at_start());
  }
  const std::uint64_t after = watch_->next_step(step);
  const bool due = step >= next_look_;
  next_look_ = due ? after : std::min(next_look_, after);  // it may go back in time
  if (!due) return;
  const bool anew = std::exchange(watched_part_, part) != part;
  tell(watch_->look(simulation_.model(), simulation_.snapshot(),
                    simulation_.playback().history().stretch(part.second).inputs, anew));
}

}  // namespace aspic::app
