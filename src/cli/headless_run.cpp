#include "cli/headless_run.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "aspic/analysis.h"
#include "base/stopwatch.h"
#include "io/console.h"
#include "model/reading.h"

namespace aspic::cli {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void BatchSize::took(std::uint64_t steps, double seconds) {
  if (steps < size_) return;
  if (seconds < 0.025) size_ = std::min<std::uint64_t>(2 * size_, 1u << 20);
  if (seconds > 0.1) size_ = std::max<std::uint64_t>(size_ / 2, 1);
}

void Losses::tell(const std::vector<Error>& failures) {
  for (; told_ < failures.size(); ++told_)
    print_warning(worded(failures[told_], FrontEnd::command_line) +
                  " The run continues with its other files.");
}

Status lost_error(const std::vector<Error>& failures, bool others) {
  if (failures.empty()) return {};
  std::string text;
  ErrorCode code = closed_pipe;
  for (const Error& failure : failures) {
    if (failure.code == closed_pipe) continue;
    if (text.empty()) code = failure.code;
    text += (text.empty() ? "" : "\n") + worded(failure, FrontEnd::command_line);
  }
  if (text.empty()) return Error{closed_pipe, ""};
  if (others) text += " All other files of the run are complete.";
  return Error{code, text};
}

// A State takes as much memory as all of a solver's: one is held while there are states to look at, and none
// while only steps are made.
Status HeadlessRun::sample() {
  ASPIC_CHECK(read_state(solver_, state_));
  ASPIC_CHECK(files_.take({.model = solver_.model(),
                           .state = state_,
                           .solves = solver_.solve_statistics().value_or(SolveStatistics{}),
                           .inputs = &solver_.inputs()}));
  const std::vector<Error>& failures = files_.failures();
  if (!failures.empty() && !files_.any_left() && !others_) return failures.front();
  losses_.tell(failures);
  if (files_.next_step(step_) == std::numeric_limits<std::uint64_t>::max() && !watch_) state_ = {};
  return {};
}

void HeadlessRun::look(const State& state) {
  warn(watch_->look(solver_.model(), state, inputs_, false));
}

void HeadlessRun::warn(std::vector<Diagnostic> found) {
  for (Diagnostic& each : found) {
    print_warning(watched_ + each.sentence());
    found_.push_back(std::move(each));
  }
}

Status HeadlessRun::begin() {
  ASPIC_CHECK(solver_.set_inputs(inputs_.at(step_)));
  return sample();
}

Status HeadlessRun::advance_to(std::uint64_t step, const InterruptGuard& interrupt,
                               const std::function<void(std::uint64_t)>& did) {
  const auto started = Clock::now();
  while (step_ < step && !divergence_ && !(interrupted_ = interrupt.interrupted())) {
    const std::uint64_t wanted = files_.next_step(step_);
    const std::uint64_t watched = watch_ ? watch_->next_step(step_) : step;
    const std::uint64_t count = std::min({batch_.next(), step - step_, wanted - step_, watched - step_});
    const auto before = Clock::now();
    ASPIC_TRY(const Advance advanced, aspic::advance(solver_, inputs_, step_, count));
    divergence_ = advanced.divergence;
    step_ += advanced.steps;
    if (divergence_) break;
    if (step_ == wanted) ASPIC_CHECK(sample());
    if (watch_ && step_ == watched) {
      if (step_ != wanted) ASPIC_CHECK(read_state(solver_, state_));
      look(state_);
    }
    batch_.took(count, seconds_since(before));
    if (did) did(step_);
  }
  seconds_ += seconds_since(started);
  return {};
}

Result<Outcome> HeadlessRun::outcome(std::uint64_t last_step) {
  const auto before = Clock::now();
  Outcome outcome;
  outcome.first_step = first_step_;
  outcome.last_step = last_step;
  outcome.divergence = divergence_;
  outcome.interrupted = interrupted_;
  ASPIC_CHECK(read_state(solver_, state_));  // the time below is that of finished work
  outcome.state = std::move(state_);
  outcome.wall_seconds = seconds_ + seconds_since(before);
  if (const auto bad = first_not_finite(measure(solver_.model(), outcome.state, solver_.inputs()))) {
    return fail(ErrorCode::diverged, "{} of step {} is not a finite number; the outputs are incomplete.",
                *bad, outcome.state.step);
  }
  if (watch_) look(outcome.state);
  outcome.diagnostics = found_;
  outcome.solves = solver_.solve_statistics();
  return outcome;
}

}  // namespace aspic::cli
