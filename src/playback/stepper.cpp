#include "playback/stepper.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "aspic/model.h"
#include "base/stopwatch.h"
#include "model/integrator.h"
#include "model/springs.h"

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double copy_every = 0.1;  // s
/// What a job takes [s]: nobody waits for it, so it may be longer than an image.
constexpr double shortest_job = 0.030, longest_job = 0.1;

/// Of those that the model reads.
void set_channels(const std::map<std::string, double>& by_hand, const Model& model,
                  std::vector<double>& channels) {
  if (by_hand.empty()) return;
  const std::vector<std::string> names = input_names(model);
  for (const auto& [name, w] : by_hand) {
    const auto channel = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    if (channel == names.size()) continue;
    channels.resize(std::max(channels.size(), channel + 1));
    channels[channel] = w;
  }
}

}  // namespace

void Stepper::set_running(bool running) {
  running_ = running && !present_.divergence();
  if (running_)
    single_steps_ = 0;
  else if (!timeline_.seeking())
    jobs_.cancel();
  pacer_.restart();
}

void Stepper::forget_future(double now) {
  timeline_.forget_future();
  figures_.samples().truncate(now);
}

/// Before steps that are not history yet. The solvers in the context must be idle.
Status Stepper::prepare() {
  if (!timeline_.at_end()) forget_future(present_.time());
  if (!present_.engines().use_context()) return {};  // else the job finds its inputs
  const Inputs now = inputs();
  timeline_.history().set_inputs(present_.step(), now);
  return present_.engines().set_inputs(now);
}

/// A model may have come to pin other particles, or to have others; what does not fit it is left out. Where a
/// hand pinned or freed a particle, which the model shows already, or set a channel, a log has no say.
Inputs Stepper::composed(Acts acts, const std::map<std::uint32_t, bool>& by_hand, const Model& model,
                         const InputLog& log, std::uint64_t step) {
  Inputs all = log.at(step);
  Inputs& followed = acts.followed;
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(all.pulls, followed.pulls);
  if (acts.hand) all.pulls.push_back(*acts.hand);
  add(all.pinned, followed.pinned);
  add(all.released, followed.released);
  if (all.channels.empty()) all.channels = std::move(followed.channels);
  set_channels(acts.channels, model, all.channels);
  std::erase_if(all.pulls, [&](const Pull& pull) {
    return pull.particle >= (pull.ball ? model.ball_count() : model.particle_count());
  });
  // The hand is the last one, and stays.
  if (const std::size_t kept = most_pulls - 1; all.pulls.size() > most_pulls)
    all.pulls.erase(all.pulls.begin() + kept, all.pulls.end() - 1);
  for (auto* const particles : {&all.pinned, &all.released}) {
    std::ranges::sort(*particles);
    particles->erase(std::unique(particles->begin(), particles->end()), particles->end());
    std::erase_if(*particles,
                  [&](std::uint32_t i) { return i >= model.particle_count() || by_hand.contains(i); });
  }
  std::erase_if(all.released, [&](std::uint32_t i) {
    return model.inverse_mass[i] != 0.0 || std::ranges::binary_search(all.pinned, i);
  });
  return all;
}

/// The first step after the present one with another part of the log, or `otherwise`, if that is earlier.
std::uint64_t Stepper::next_change(std::uint64_t otherwise) const {
  return std::min(otherwise, log_->next_change(present_.step()).value_or(otherwise));
}

bool Stepper::steps_quickly() const {
  // Of springs by force evaluations, about 50 ms on the slowest backend.
  constexpr double quick = 4e6, solve = 100.0;
  const Model& model = present_.model();
  const Integrator method = model.simulation.integrator;
  const double evaluations = row_of(method).traits.long_steps ? solve : force_evaluations_per_step(method);
  return Engines::in_context(present_.engines().leader()) ||
         evaluations * static_cast<double>(spring_count(model)) < quick;
}

void Stepper::note(std::uint64_t steps, const std::optional<Divergence>& divergence) {
  present_.advance(steps);
  pacer_.did(steps);
  if (!timeline_.seeking()) {
    timeline_.history().reach(present_.step());
    single_steps_ -= std::min(single_steps_, steps);
  }
  if (divergence) {
    set_running(false);
    single_steps_ = 0;
    timeline_.stop();
    present_.set_divergence(divergence);
  }
}

/// The leader in the context is at this step, or will be: it tells of a divergence up to two queues late.
void Stepper::reach(std::uint64_t step, const std::optional<Divergence>& divergence) {
  const bool back = step < present_.step();
  note(back ? 0 : step - present_.step(), divergence);
  if (!back) return;
  present_.set_step(step);
  forget_future(present_.time());
}

Status Stepper::advance(double dt, double budget) {
  const Engines& engines = present_.engines();
  const std::uint64_t steps = pacer_.steps_due(dt, present_.model().simulation, present_.step());
  if (steps == 0) return {};
  const std::uint64_t to = present_.step() + steps;
  // Where no solver needs the context a second job is queued, so that the solvers never idle while an image
  // is drawn.
  const bool queues = !engines.use_context() && jobs_.count() < 2 && to > job_to_;
  if (!engines.only_context() && !jobs_.idle() && !queues) return {};
  return advance_to(
      to, engines.only_context() ? budget : std::max({budget, shortest_job, std::min(dt, longest_job)}));
}

Status Stepper::advance_to(std::uint64_t to, double budget) {
  ASPIC_CHECK(prepare());
  if (!present_.engines().only_context()) {
    start_job(to, budget, std::nullopt);
    return {};
  }
  const auto start = Clock::now();
  const std::uint64_t before = present_.step();
  for (;;) {
    const std::uint64_t stop = next_change(to);
    ASPIC_CHECK(advance_here(stop - present_.step(), budget - seconds_since(start)));
    if (present_.step() != stop || stop == to || seconds_since(start) > 0.75 * budget) break;
    ASPIC_CHECK(prepare());
  }
  if (!present_.engines().shadowed()) return {};
  ASPIC_CHECK(refresh_snapshot());
  JobResult result;
  result.steps = present_.step() - before;
  result.leader = {present_.snapshot(), present_.divergence()};
  return follow(std::move(result));
}

Status Stepper::repeat_to(std::uint64_t to, double budget, const Inputs& inputs) {
  ASPIC_CHECK(present_.engines().set_inputs(inputs));
  if (Engines::in_context(present_.engines().leader())) return advance_here(to - present_.step(), budget);
  start_job(to, std::max(budget, shortest_job), inputs);
  return {};
}

/// Steps of the leader, in the context, in batches.
Status Stepper::advance_here(std::uint64_t steps, double budget) {
  const auto start = Clock::now();
  std::uint64_t done = 0;
  while (done < steps && !present_.divergence()) {
    const bool seeking = timeline_.seeking();
    const std::uint64_t sample = figures_.next_step();
    const std::uint64_t count = std::min({batch_, steps - done, seeking ? steps : sample - present_.step()});
    const auto before = Clock::now();
    ASPIC_TRY(const auto advanced, present_.engines().leader().solver->advance(count));
    reach(advanced.divergence ? advanced.divergence->step - 1 : present_.step() + advanced.steps,
          advanced.divergence);
    done += count;
    const double took = seconds_since(before);
    // A batch is about a quarter of the budget, so that its end is not far beyond.
    if (count == batch_ && took < 0.125 * std::min(budget, shortest_job))
      batch_ = std::min<std::uint64_t>(2 * batch_, 256);
    if (took > 0.5 * budget) batch_ = std::max<std::uint64_t>(batch_ / 2, 1);
    if (!timeline_.seeking() && !present_.divergence() && present_.step() == sample)
      ASPIC_CHECK(sample_here());
    if (seconds_since(start) > 0.75 * budget) break;
  }
  if (timeline_.seeking() || (!present_.divergence() && present_.snapshot_age() <= copy_every)) return {};
  ASPIC_CHECK(refresh_snapshot());
  figures_.remember(present_.snapshot(), {});
  return {};
}

/// The energies of a backend in the context.
Status Stepper::sample_here() {
  if (!figures_.begin_reading()) return {};
  ASPIC_CHECK(refresh_snapshot());
  figures_.remember(present_.snapshot(), {});
  figures_.measure(present_.snapshot());
  figures_.end_reading();
  return {};
}

/// Steps of the solvers without the context; those within it have their inputs already. Steps that are
/// `repeated`, with these inputs, are the leader's alone; others go no further than the log's next change.
void Stepper::start_job(std::uint64_t to, double budget, const std::optional<Inputs>& repeated) {
  // Where results wait to be taken up the solvers are further than the present.
  if (jobs_.idle()) job_step_ = present_.step();
  job_to_ = to;
  const auto advance = [=, this, log = log_, acts = acts_, by_hand = present_.setup().pinned](
                           const std::atomic<bool>& canceled) -> Result<JobResult> {
    Engines& engines = present_.engines();
    const Inputs inputs = repeated ? *repeated : composed(acts, by_hand, engines.model(), *log, job_step_);
    ASPIC_CHECK(engines.use_context() ? Status() : engines.set_inputs(inputs));
    const std::uint64_t stop = repeated ? to : std::min(to, log->next_change(job_step_).value_or(to));
    const JobLimits limits = {job_step_, std::max(stop, job_step_), budget, repeated.has_value()};
    ASPIC_TRY(JobResult result, engines.advance_outside(limits, canceled));
    result.inputs = inputs;
    job_step_ += result.steps;
    return result;
  };
  jobs_.start([this, advance](const std::atomic<bool>& canceled) -> Jobs::TakeUp {
    return [this, result = advance(canceled)]() mutable -> Status {
      if (!result) return result.error();
      return take_up(std::move(*result));
    };
  });
}

Status Stepper::take_up(JobResult result) {
  const Engines& engines = present_.engines();
  const bool seeking = timeline_.seeking();
  const bool stepped = result.steps > 0 || result.leader.divergence || result.shadow.divergence;
  if (stepped && !seeking) timeline_.history().set_inputs(present_.step(), result.inputs);
  if (engines.shadowed() && stepped && !seeking) return follow(std::move(result));
  const bool in_context = Engines::in_context(engines.leader());
  const State& paced = engines.shadow_paces() ? result.shadow.state : result.leader.state;
  if (!in_context && stepped) {
    present_.take_snapshot(std::move(result.leader.state));
    note(result.steps, result.leader.divergence);
  }
  if (timeline_.seeking()) return {};
  figures_.remember(in_context || !stepped ? paced : present_.snapshot(), result.energies);
  return {};
}

/// Shadow mode: the solver that needs the context does the steps that the job has done, and the two states
/// are compared.
Status Stepper::follow(JobResult result) {
  Engines& engines = present_.engines();
  ASPIC_CHECK(engines.follow(result));
  present_.take_snapshot(std::move(result.leader.state));
  const State& snapshot = present_.snapshot();
  note(snapshot.step - present_.step(), result.leader.divergence);
  const bool one_diverged = result.leader.divergence.has_value() != result.shadow.divergence.has_value();
  figures_.samples().compare(present_.time(), snapshot, result.shadow.state, one_diverged);
  if (one_diverged) set_running(false);
  figures_.remember(engines.shadow_paces() ? result.shadow.state : snapshot, result.energies);
  return {};
}

Status Stepper::refresh_snapshot() {
  const Backend& leader = present_.engines().leader();
  // The solver may be further than what was taken up of it.
  if (!Engines::in_context(leader) && !jobs_.idle()) return {};
  auto state = leader.solver->state();
  if (!state) return fall_back(state.error());
  present_.take_snapshot(std::move(*state));
  if (Engines::in_context(leader) && !present_.divergence()) {
    ASPIC_TRY(const auto found, leader.solver->advance(0));
    if (found.divergence) reach(present_.snapshot().step, found.divergence);
  }
  present_.set_step(present_.snapshot().step);
  return {};
}

Status Stepper::install(Setup setup, Result<Engines> engines) {
  ASPIC_CHECK(present_.install(std::move(setup), std::move(engines)));
  const Model& model = present_.model();
  if (acts_.hand && acts_.hand->particle >= (acts_.hand->ball ? model.ball_count() : model.particle_count()))
    acts_.hand.reset();  // what it held is no more
  batch_ = 1;
  figures_.restart_stride();
  return {};
}

Status Stepper::load(const State& state) {
  ASPIC_CHECK(present_.load(state));
  pacer_.drop_due();
  return {};
}

Status Stepper::fall_back(const Error& error) {
  Engines& engines = present_.engines();
  if (!engines.use_context()) return error;
  jobs_.finish();
  jobs_.forget();
  engines.set_shadow({});
  timeline_.stop();
  const State copy = present_.snapshot();
  if (!Engines::in_context(engines.leader())) {
    present_.tell({error.code, fmt::format("{} Shadow mode has ended.", error.what)});
    return load(copy);  // the leader may be steps ahead of what was taken from it
  }
  ASPIC_TRY(auto engine, factory_.make(engines.shared_model(), contextless_backend(), nullptr));
  engines.set_leader(std::move(engine));
  const std::uint64_t step = present_.step(), lost = step > copy.step ? step - copy.step : 0;
  History& history = timeline_.history();
  const std::uint64_t stretch = timeline_.here().stretch;
  if (copy.step >= history.stretch(stretch).first && copy.step < step) history.truncate({stretch, copy.step});
  // Its remedy is this one.
  present_.tell(
      {error.code,
       fmt::format("{} The {} continues from the last copy, {:.2f} s old (t = {:.6g} s; {} steps are "
                   "repeated).",
                   error.what, contextless_backend().title, present_.snapshot_age(),
                   static_cast<double>(copy.step) * present_.model().simulation.timestep, lost)});
  return load(copy);
}

}  // namespace aspic
