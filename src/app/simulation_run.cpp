// What moves a run, forward and through its history.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/compare.h"
#include "app/simulation.h"
#include "model/integrator.h"

namespace aspic::app {
namespace {

constexpr std::size_t most_samples = 2000;
/// Keyframes stand this far apart in running time, farther where memory would not hold the last half minute.
constexpr double keyframe_interval = 0.1, history_seconds = 30.0;  // s
constexpr auto sample_every = std::chrono::milliseconds(100);
/// Nobody waits for a job, so it may take longer than a picture [s].
constexpr double shortest_job = 0.030;
constexpr double rate_window = 0.5;  // s

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void Simulation::set_running(bool running) {
  running_ = running && !divergence_;
  due_ = 0.0;
  behind_ = false;
  rate_start_ = Clock::now();
  rate_steps_ = 0;
  if (!running_) steps_per_second_ = 0.0;
}

Status Simulation::give_pull(const std::optional<Pull>& pull) {
  if (given_ == pull) return {};
  for (Backend* engine : {&engine_, &shadow_}) {
    if (!engine->solver) continue;
    ASPIC_CHECK(engine->solver->set_pull(pull));
  }
  given_ = pull;
  return {};
}

void Simulation::forget_future() {
  history_.truncate(here());
  while (!energies_.empty() && energies_.back().time > time()) energies_.pop_back();
  while (!differences_.empty() && differences_.back().time > time()) differences_.pop_back();
}

/// Before steps that are not history yet. The solvers must be idle.
Status Simulation::prepare_to_advance() {
  if (!at_end()) forget_future();
  if (history_.pull_at(here()) != hand_) history_.set_pull(step_, hand_);
  return give_pull(hand_);
}

Status Simulation::single_step() {
  if (running_ || divergence_) return {};
  ASPIC_CHECK(settle());
  if (const auto next = history_.after(here())) {
    ASPIC_CHECK(seek(*next));
    return settle();
  }
  ASPIC_CHECK(prepare_to_advance());
  const auto advanced = engine_.solver->advance(1);
  if (!advanced) return engine_.gpu ? fall_back(advanced.error()) : Status(advanced.error());
  note(*advanced ? 0 : 1, *advanced);
  ASPIC_CHECK(refresh_snapshot());
  if (shadowed()) {
    const auto followed = shadow_.solver->advance(1);
    if (!followed) return fall_back(followed.error());
    const auto other = shadow_.solver->state();
    if (!other) return fall_back(other.error());
    compare_shadow(*other);
  }
  add_sample(snapshot_, measure(*model_, snapshot_));
  return {};
}

void Simulation::note(std::uint64_t steps, const std::optional<Divergence>& divergence) {
  step_ += steps;
  rate_steps_ += steps;
  due_ = std::max(due_ - static_cast<double>(steps), 0.0);
  if (steps > 0) ++picture_number_;
  if (!seek_) history_.reach(step_);
  if (divergence) {
    set_running(false);
    seek_.reset();
    divergence_ = divergence;
  }
}

Status Simulation::update(double dt, double budget) {
  Status moved;
  if (!worker_.busy()) moved = take_outcome();
  if (moved && wanted_change_ && !worker_.busy() && !has_outcome_) start_change();
  if (moved && change_) return {};
  if (moved && seek_)
    moved = seek_on(budget);
  else if (moved && running_)
    moved = advance_run(dt, budget);
  // What is told of a pause is what is seen.
  else if (moved && engine_.gpu && snapshot_.step != step_)
    moved = refresh_snapshot();
  if (!moved && (engine_.gpu || shadow_.gpu)) return fall_back(moved.error());
  return moved;
}

Status Simulation::advance_run(double dt, double budget) {
  const SimulationSettings& s = model_->simulation;
  const double asked = pace == Pace::real_time ? speed * dt / s.timestep : speed * s.steps_per_frame;
  due_ += asked;
  // What was not done within two pictures is never made good: the factor tells, the motion does not jump.
  const double most = std::max(2.0 * asked, 1.0);
  behind_ = due_ > most;
  due_ = std::min(due_, most);
  if (const double window = seconds_since(rate_start_); window > rate_window) {
    steps_per_second_ = static_cast<double>(rate_steps_) / window;
    rate_start_ = Clock::now();
    rate_steps_ = 0;
  }
  auto steps = static_cast<std::uint64_t>(due_);
  if (pause_step_) steps = std::min(steps, *pause_step_ > step_ ? *pause_step_ - step_ : 0);
  if (steps == 0) return {};
  if (engine_.gpu && !shadowed()) {
    ASPIC_CHECK(prepare_to_advance());
    return advance_gpu(steps, budget);
  }
  // A job that came to its end since the last look still has its outcome to hand over.
  if (worker_.busy() || has_outcome_) return {};
  ASPIC_CHECK(prepare_to_advance());
  start_job(steps, std::max(budget, shortest_job));
  return {};
}

Status Simulation::advance_gpu(std::uint64_t steps, double budget) {
  const auto start = Clock::now();
  std::uint64_t done = 0;
  while (done < steps && !divergence_) {
    const std::uint64_t count = std::min(batch_, steps - done);
    const auto before = Clock::now();
    const auto advanced = engine_.solver->advance(count);
    if (!advanced) return advanced.error();
    std::uint64_t good = count;
    if (*advanced) good = (*advanced)->step - 1 - step_;
    note(good, *advanced);
    done += count;
    const double took = seconds_since(before);
    // A batch is about a quarter of the budget, so that its end is not far beyond.
    if (count == batch_ && took < 0.125 * budget) batch_ = std::min<std::uint64_t>(2 * batch_, 256);
    if (took > 0.5 * budget) batch_ = std::max<std::uint64_t>(batch_ / 2, 1);
    if (seconds_since(start) > 0.75 * budget) break;
  }
  if (!seek_ && (divergence_ || Clock::now() - last_sampled_ > sample_every)) {
    ASPIC_CHECK(refresh_snapshot());
    if (!worker_.busy() && !has_outcome_) start_measuring();
  }
  return {};
}

void Simulation::start_measuring() {
  last_sampled_ = Clock::now();
  has_outcome_ = true;
  outcome_ = Outcome{};
  outcome_.state = snapshot_;
  worker_.start([this](const std::atomic<bool>&) { outcome_.measures = measure(*model_, outcome_.state); });
}

void Simulation::start_job(std::uint64_t steps, double budget) {
  has_outcome_ = true;
  outcome_ = Outcome{};
  Solver& solver = engine_.gpu ? *shadow_.solver : *engine_.solver;
  Solver* const other = engine_.gpu || shadow_.gpu || seek_ ? nullptr : shadow_.solver.get();
  worker_.start([this, steps, budget, &solver, other](const std::atomic<bool>& hurry) {
    const auto start = Clock::now();
    while (outcome_.steps < steps && !hurry) {
      const auto advanced = solver.advance(1);
      if (!advanced) {
        outcome_.error = advanced.error();
        return;
      }
      outcome_.divergence = *advanced;
      if (outcome_.divergence) break;
      ++outcome_.steps;
      if (seconds_since(start) > budget) break;
    }
    auto state = solver.state();
    if (!state) {
      outcome_.error = state.error();
      return;
    }
    outcome_.state = std::move(*state);
    outcome_.measures = measure(*model_, outcome_.state);
    if (other == nullptr) return;
    // A step that failed on one side is tried on the other.
    const auto followed = other->advance(outcome_.steps + (outcome_.divergence ? 1 : 0));
    auto other_state = followed ? other->state() : Result<State>(followed.error());
    if (!other_state) {
      outcome_.error = other_state.error();
      return;
    }
    outcome_.other_divergence = *followed;
    outcome_.other_state = std::move(*other_state);
  });
}

Status Simulation::take_outcome() {
  if (!has_outcome_) return {};
  has_outcome_ = false;
  Outcome outcome = std::move(outcome_);
  if (outcome.error) return *outcome.error;
  if (outcome.built) {
    Change change = std::move(*change_);
    change_.reset();
    change_result_ = finish_change(std::move(change), std::move(*outcome.built));
    return {};
  }
  const bool stepped = outcome.steps > 0 || outcome.divergence;
  if (shadowed() && stepped && !seek_) {
    return follow(std::move(outcome));
  } else if (!engine_.gpu) {
    snapshot_ = std::move(outcome.state);
    snapshot_time_ = Clock::now();
    note(outcome.steps, outcome.divergence);
    if (!seek_) add_sample(snapshot_, outcome.measures);
    return {};
  }
  if (!seek_) add_sample(outcome.state, outcome.measures);
  return {};
}

/// Shadow mode: the solver that needs the context does the steps that the job has done, and the two states
/// are compared.
Status Simulation::follow(Outcome outcome) {
  if (GpuSolver* const gpu = engine_.gpu ? engine_.gpu : shadow_.gpu) {
    // A step that failed on one side is tried on the other.
    const auto advanced = gpu->advance(outcome.steps + (outcome.divergence ? 1 : 0));
    if (!advanced) return advanced.error();
    auto state = gpu->state();
    if (!state) return state.error();
    outcome.other_divergence = *advanced;
    outcome.other_state = std::move(*state);
  }
  const Measures measures = outcome.measures;
  if (engine_.gpu) {
    std::swap(outcome.state, outcome.other_state);
    std::swap(outcome.divergence, outcome.other_divergence);
  }
  snapshot_ = std::move(outcome.state);
  snapshot_time_ = Clock::now();
  note(snapshot_.step - step_, outcome.divergence);
  compare_shadow(outcome.other_state);
  if (outcome.divergence.has_value() != outcome.other_divergence.has_value()) {
    differences_.back().metres = std::numeric_limits<double>::infinity();
    differences_.back().identical = false;
    ever_differed_ = true;
    set_running(false);
  }
  // The measures are those of the job's own state.
  add_sample(engine_.gpu ? outcome.other_state : snapshot_, measures);
  return {};
}

void Simulation::compare_shadow(const State& other) {
  DifferenceSample sample;
  sample.time = time();
  const auto difference = compare_states(snapshot_, other);
  if (difference && snapshot_.step == other.step) {
    sample.metres = std::max(difference->position.absolute, difference->ball_position.absolute);
    sample.ulp = std::max({difference->position.ulp, difference->velocity.ulp, difference->ball_position.ulp,
                           difference->ball_velocity.ulp, difference->ball_angular_velocity.ulp});
    sample.identical = difference->identical();
  } else {
    sample.metres = std::numeric_limits<double>::infinity();
  }
  ever_differed_ = ever_differed_ || !sample.identical;
  while (!differences_.empty() && differences_.back().time >= sample.time) differences_.pop_back();
  differences_.push_back(sample);
  if (differences_.size() > most_samples) differences_.pop_front();
}

Status Simulation::settle() {
  worker_.finish();
  if (const Status taken = take_outcome(); !taken) return fall_back(taken.error());
  while (seek_) {
    worker_.wait();
    Status moved = take_outcome();
    if (moved && seek_) moved = seek_on(std::numeric_limits<double>::infinity());
    if (!moved) return fall_back(moved.error());
  }
  return refresh_snapshot();
}

Status Simulation::refresh_snapshot() {
  if (!engine_.gpu && worker_.busy()) return {};
  auto state = engine_.solver->state();
  if (!state) return fall_back(state.error());
  snapshot_ = std::move(*state);
  snapshot_time_ = Clock::now();
  step_ = snapshot_.step;
  return {};
}

// ---- history ----

Status Simulation::seek(const Moment& moment) {
  set_running(false);
  wanted_change_.reset();
  worker_.finish();
  if (const Status taken = take_outcome(); !taken) return fall_back(taken.error());
  const std::optional<std::uint64_t> underway = std::exchange(seek_, std::nullopt);
  if (moment == here() && !underway) return settle();
  const Keyframe& keyframe = history_.keyframe(moment);
  const bool on_the_way = moment.stretch == stretch_ && step_ <= moment.step && step_ >= keyframe.step;
  if (moment.stretch != stretch_) {
    ASPIC_CHECK(rebuild(history_.stretch(moment.stretch).setup));
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

Status Simulation::seek_on(double budget) {
  const auto start = Clock::now();
  while (seek_ && step_ < *seek_) {
    if (worker_.busy() || has_outcome_) return {};
    ASPIC_CHECK(give_pull(history_.pull_at(here())));
    const std::uint64_t stop = std::min(*seek_, history_.next_pull_change(here()).value_or(*seek_));
    if (!engine_.gpu) {
      start_job(stop - step_, std::max(budget, shortest_job));
      return {};
    }
    ASPIC_CHECK(advance_gpu(stop - step_, budget - seconds_since(start)));
    if (seconds_since(start) > 0.75 * budget) return {};
  }
  return finish_seek();
}

Status Simulation::finish_seek() {
  seek_.reset();
  ASPIC_CHECK(refresh_snapshot());
  if (!shadowed()) return {};
  return shadow_.solver->load(snapshot_);
}

Status Simulation::step_back() {
  const Moment from = {stretch_, seek_.value_or(step_)};
  const auto earlier = history_.before(from);
  return earlier ? seek(*earlier) : Status();
}

void Simulation::remember(const State& state) {
  if (divergence_ || !at_end()) return;
  const double bytes = 24.0 * static_cast<double>(state.position.size());
  const double interval =
      std::max(keyframe_interval, history_seconds * bytes / static_cast<double>(history_.most_bytes()));
  if (seconds_since(last_remembered_) < interval) return;
  last_remembered_ = Clock::now();
  history_.add_keyframe(state);
}

void Simulation::add_sample(const State& state, const Measures& measures) {
  remember(state);
  const double t = static_cast<double>(state.step) * model_->simulation.timestep;
  while (!energies_.empty() && energies_.back().time >= t) energies_.pop_back();
  energies_.push_back({t, measures, state.step});
  if (energies_.size() <= most_samples) return;
  // Half as dense: the whole run stays in the plot.
  std::deque<EnergySample> thinner;
  for (std::size_t i = 0; i < energies_.size(); i += 2) thinner.push_back(energies_[i]);
  energies_ = std::move(thinner);
}

std::optional<double> Simulation::spring_evaluations_per_second() const {
  if (row_of(model_->simulation.integrator).solved()) return std::nullopt;
  return steps_per_second_ * static_cast<double>(model_->springs.size()) *
         force_evaluations_per_step(model_->simulation.integrator);
}

}  // namespace aspic::app
