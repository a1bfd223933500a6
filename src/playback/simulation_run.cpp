// What moves a run forward.
#include <algorithm>
#include <limits>
#include <utility>

#include "model/integrator.h"
#include "model/springs.h"
#include "playback/simulation.h"

namespace aspic {
namespace {

/// Keyframes are this far apart in running time, farther where memory would not hold the last half minute.
constexpr double keyframe_interval = 0.1, history_seconds = 30.0;  // s
constexpr auto copy_every = std::chrono::milliseconds(100);
/// What a job takes at most [s].
constexpr double longest_job = 0.1;

double running_time_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void Simulation::set_running(bool running) {
  running_ = running && !divergence_;
  if (running_)
    single_steps_ = 0;
  else if (!change_ && !seek_)
    worker_.cancel();
  pacer_.restart();
}

void Simulation::take_snapshot(State state) {
  snapshot_ = std::move(state);
  snapshot_time_ = Clock::now();
}

void Simulation::forget_future(double now) {
  history_.truncate(here());
  ended_.reset();
  samples_.truncate(now);
}

/// Before steps that are not history yet. The solvers in the context must be idle.
Status Simulation::prepare_to_advance() {
  if (!at_end()) forget_future(time());
  if (!engines_.use_context()) return {};  // else the job takes the pull along
  if (history_.pull_at(here()) != hand_) history_.set_pull(step_, hand_);
  return engines_.set_pull(hand_);
}

/// A step takes so little time that the window can wait for it.
bool Simulation::steps_quickly() const {
  // Of springs by force evaluations, about 50 ms on the slowest backend.
  constexpr double quick = 4e6, solve = 100.0;
  const Integrator method = model().simulation.integrator;
  const double evaluations = row_of(method).traits.long_steps ? solve : force_evaluations_per_step(method);
  return Engines::in_context(engines_.leader()) ||
         evaluations * static_cast<double>(spring_count(model())) < quick;
}

Status Simulation::single_step() {
  if (running_ || divergence_) return {};
  ++single_steps_;
  return steps_quickly() ? settle() : Status();
}

void Simulation::note(std::uint64_t steps, const std::optional<Divergence>& divergence) {
  step_ += steps;
  pacer_.did(steps);
  if (steps > 0) ++picture_number_;
  if (!seek_) {
    history_.reach(step_);
    single_steps_ -= std::min(single_steps_, steps);
  }
  if (divergence) {
    set_running(false);
    single_steps_ = 0;
    seek_.reset();
    divergence_ = divergence;
  }
}

/// The leader in the context is at this step, or will be: it tells of a divergence up to two queues late.
void Simulation::reach(std::uint64_t step, const std::optional<Divergence>& divergence) {
  const bool back = step < step_;
  note(back ? 0 : step - step_, divergence);
  if (!back) return;
  step_ = step;
  forget_future(time());
}

Status Simulation::update(double dt, double budget) {
  if (!worker_.busy()) worker_.wait();  // for an exception
  Status moved = collect();
  const bool waits = requested_ && !seek_;
  if (moved && waits && idle()) start_change();
  if (moved && change_) return {};
  if (moved && seek_)
    moved = seek_on(budget);
  else if (moved && running_ && !(waits && !engines_.only_context()))
    moved = advance_run(dt, budget);
  else if (moved && single_steps_ > 0)
    moved = step_singly();
  else if (moved && !running_)
    moved = show_figures();
  return moved ? Status() : fall_back(moved.error());
}

/// While paused, all figures are of the state that is shown.
Status Simulation::show_figures() {
  if (Engines::in_context(engines_.leader()) && snapshot_.step != step_) return refresh_snapshot();
  const EnergySample* const known = samples_.nearest(time());
  if (idle() && !divergence_ && (!known || known->time != time())) start_measuring();
  return {};
}

/// The next of the single steps that were asked for.
Status Simulation::step_singly() {
  if (!idle()) return {};
  if (const auto next = history_.after(here())) {
    --single_steps_;
    return seek(*next);
  }
  return start_steps(step_ + 1, std::numeric_limits<double>::infinity());
}

Status Simulation::advance_run(double dt, double budget) {
  const std::uint64_t steps = pacer_.steps_due(dt, model().simulation, step_);
  if (steps == 0) return {};
  // Where all solvers go on by themselves one job waits for the end of another, so that they never stand
  // still while a picture is drawn.
  const bool queues = !engines_.use_context() && worker_.jobs() < 2 && step_ + steps > job_to_;
  if (!engines_.only_context() && !idle() && !queues) return {};
  return start_steps(step_ + steps, engines_.only_context()
                                        ? budget
                                        : std::max({budget, shortest_job, std::min(dt, longest_job)}));
}

/// Up to that step at most; in the context at once, else in a job.
Status Simulation::start_steps(std::uint64_t to, double budget) {
  ASPIC_CHECK(prepare_to_advance());
  if (!engines_.only_context()) {
    start_job(to, budget, false, hand_);
    return {};
  }
  const std::uint64_t before = step_;
  ASPIC_CHECK(advance_here(to - step_, budget));
  if (!shadowed()) return {};
  ASPIC_CHECK(refresh_snapshot());
  JobResult outcome;
  outcome.steps = step_ - before;
  outcome.leader = {snapshot_, divergence_};
  return follow(std::move(outcome));
}

/// Steps of the leader, in the context, in batches.
Status Simulation::advance_here(std::uint64_t steps, double budget) {
  const auto start = Clock::now();
  std::uint64_t done = 0;
  while (done < steps && !divergence_) {
    const std::uint64_t sample = next_sample_step(step_, model().simulation.timestep, sample_stride_);
    const std::uint64_t count = std::min({batch_, steps - done, seek_ ? steps : sample - step_});
    const auto before = Clock::now();
    ASPIC_TRY(const auto advanced, engines_.leader().solver->advance(count));
    reach(advanced ? advanced->step - 1 : step_ + count, advanced);
    done += count;
    const double took = running_time_since(before);
    // A batch is about a quarter of the budget, so that its end is not far beyond.
    if (count == batch_ && took < 0.125 * std::min(budget, shortest_job))
      batch_ = std::min<std::uint64_t>(2 * batch_, 256);
    if (took > 0.5 * budget) batch_ = std::max<std::uint64_t>(batch_ / 2, 1);
    if (!seek_ && !divergence_ && step_ == sample) ASPIC_CHECK(sample_here());
    if (running_time_since(start) > 0.75 * budget) break;
  }
  if (seek_ || (!divergence_ && Clock::now() - snapshot_time_ <= copy_every)) return {};
  ASPIC_CHECK(refresh_snapshot());
  remember(snapshot_, {});
  return {};
}

/// The energies of a backend in the context, at the same steps in every run: as many as take a quarter of the
/// time at most. Where they take more, every second one is left out from now on.
Status Simulation::sample_here() {
  const double since_last = running_time_since(last_sampled_);
  if (worker_.jobs() > 3 || read_seconds_ > 0.25 * since_last)
    sample_stride_ *= 2;
  else if (sample_stride_ > 1 && read_seconds_ < 0.05 * since_last)
    sample_stride_ /= 2;
  if (worker_.jobs() > 3) return {};
  last_sampled_ = Clock::now();
  ASPIC_CHECK(refresh_snapshot());
  remember(snapshot_, {});
  start_measuring();
  read_seconds_ = running_time_since(last_sampled_);
  return {};
}

/// The energies of the snapshot.
void Simulation::start_measuring() {
  worker_.start([this, state = snapshot_](const std::atomic<bool>&) {
    JobResult outcome;
    outcome.energies = {engines_.measured(state)};
    (engines_.shadow_paces() ? outcome.shadow : outcome.leader).state = state;
    outcomes_.put(std::move(outcome));
  });
}

/// Steps of the solvers without the context; those within it have this pull already.
void Simulation::start_job(std::uint64_t to, double budget, bool alone, std::optional<Pull> pull) {
  if (!worker_.busy()) {
    job_step_ = step_;
    progress_ = Clock::now();
  }
  job_to_ = to;
  const auto job = [=, this](const std::atomic<bool>& cancelled) -> Result<JobResult> {
    ASPIC_CHECK(engines_.use_context() ? Status() : engines_.set_pull(pull));
    const JobLimits limits = {job_step_, std::max(to, job_step_), budget, alone};
    ASPIC_TRY(JobResult outcome, engines_.advance_outside(limits, cancelled));
    outcome.pull = pull;
    job_step_ += outcome.steps;
    return outcome;
  };
  worker_.start([this, job](const std::atomic<bool>& cancelled) { outcomes_.put(job(cancelled)); });
}

Status Simulation::collect() {
  while (auto outcome = outcomes_.take()) {
    ASPIC_TRY(JobResult done, std::move(*outcome));
    ASPIC_CHECK(take(std::move(done)));
  }
  return {};
}

Status Simulation::take(JobResult outcome) {
  progress_ = Clock::now();
  if (change_) {
    Change change = std::move(*change_);
    change_.reset();
    change_result_ = finish_change(std::move(change));
    return {};
  }
  const bool stepped = outcome.steps > 0 || outcome.leader.divergence || outcome.shadow.divergence;
  if (stepped && !seek_ && history_.pull_at(here()) != outcome.pull) history_.set_pull(step_, outcome.pull);
  if (shadowed() && stepped && !seek_) return follow(std::move(outcome));
  const bool in_context = Engines::in_context(engines_.leader());
  const State& paced = engines_.shadow_paces() ? outcome.shadow.state : outcome.leader.state;
  if (!in_context && stepped) {
    take_snapshot(std::move(outcome.leader.state));
    note(outcome.steps, outcome.leader.divergence);
  }
  if (seek_) return {};
  // States of a backend in the context were kept when they were read: these are older.
  if (in_context && !engines_.shadow_paces())
    for (const EnergySample& sample : outcome.energies) samples_.add(sample);
  else
    remember(in_context || !stepped ? paced : snapshot_, outcome.energies);
  return {};
}

/// Shadow mode: the solver that needs the context does the steps that the job has done, and the two states
/// are compared.
Status Simulation::follow(JobResult outcome) {
  ASPIC_CHECK(engines_.follow(outcome));
  take_snapshot(std::move(outcome.leader.state));
  note(snapshot_.step - step_, outcome.leader.divergence);
  const bool one_diverged = outcome.leader.divergence.has_value() != outcome.shadow.divergence.has_value();
  samples_.compare(time(), snapshot_, outcome.shadow.state, one_diverged);
  if (one_diverged) set_running(false);
  remember(engines_.shadow_paces() ? outcome.shadow.state : snapshot_, outcome.energies);
  return {};
}

Status Simulation::halt(bool arrive) {
  worker_.finish();
  Status moved = collect();
  while (arrive && moved && seek_) {
    moved = seek_on(std::numeric_limits<double>::infinity());
    worker_.wait();
    if (moved) moved = collect();
  }
  return moved ? refresh_snapshot() : fall_back(moved.error());
}

Status Simulation::settle() {
  ASPIC_CHECK(halt(true));
  while (single_steps_ > 0 && !divergence_) {
    ASPIC_CHECK(step_singly());
    worker_.wait();
    ASPIC_CHECK(halt(true));
  }
  return {};
}

bool Simulation::working() const {
  constexpr double noticeable = 0.5;  // s
  return worker_.busy() && !has_news() && running_time_since(progress_) > noticeable;
}

Status Simulation::refresh_snapshot() {
  // The solver may be further than what was taken up of it.
  if (!Engines::in_context(engines_.leader()) && !idle()) return {};
  auto state = engines_.leader().solver->state();
  if (!state) return fall_back(state.error());
  take_snapshot(std::move(*state));
  if (Engines::in_context(engines_.leader()) && !divergence_) {
    ASPIC_TRY(const auto found, engines_.leader().solver->advance(0));
    if (found) reach(snapshot_.step, found);
  }
  step_ = snapshot_.step;
  return {};
}

// ---- history ----

/// Keeps a state that was come to, now and then, and points of the plot.
void Simulation::remember(const State& state, const std::vector<EnergySample>& energies) {
  if (!divergence_ && at_end()) {
    const double bytes = 24.0 * static_cast<double>(state.position.size());
    const double interval =
        std::max(keyframe_interval, history_seconds * bytes / static_cast<double>(history_.most_bytes()));
    if (running_time_since(last_remembered_) >= interval) {
      last_remembered_ = Clock::now();
      history_.add_keyframe(state);
    }
  }
  for (const EnergySample& sample : energies) samples_.add(sample);
}

std::optional<double> Simulation::spring_evaluations_per_second() const {
  const Integrator integrator = model().simulation.integrator;
  if (!row_of(integrator).staged()) return std::nullopt;
  return pacer_.steps_per_second() * static_cast<double>(spring_count(model())) *
         force_evaluations_per_step(integrator);
}

}  // namespace aspic
