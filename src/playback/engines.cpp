#include "playback/engines.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

Status advance(const Backend& engine, std::uint64_t steps, Advanced& into) {
  ASPIC_TRY(auto advanced, engine.solver->advance(steps));
  ASPIC_TRY(auto state, engine.solver->state());
  // A device may tell of a divergence once it was waited for.
  ASPIC_TRY(advanced, engine.solver->advance(0));
  into.divergence = advanced.divergence;
  into.state = std::move(state);
  return {};
}

/// A step that failed on one side is tried on the other.
std::uint64_t tried_steps(const JobResult& outcome, const Advanced& paced) {
  return outcome.steps + (paced.divergence ? 1 : 0);
}

}  // namespace

Status Engines::load(const State& state) {
  ASPIC_CHECK(leader_.solver->load(state));
  return shadowed() ? shadow_.solver->load(state) : Status();
}

Status Engines::set_inputs(const Inputs& inputs) {
  ASPIC_CHECK(leader_.solver->set_inputs(inputs));
  return shadowed() ? shadow_.solver->set_inputs(inputs) : Status();
}

Status Engines::set_constants(SharedModel model) {
  ASPIC_CHECK(leader_.solver->set_constants(model));
  if (shadowed()) ASPIC_CHECK(shadow_.solver->set_constants(model));
  model_ = std::move(model);
  meter_ = std::make_unique<Meter>(*model_);
  return {};
}

EnergySample Engines::measured(const State& state) const {
  const Inputs& inputs = leader_.solver->inputs();
  EnergySample sample = {static_cast<double>(state.step) * model_->simulation.timestep,
                         meter_->measure(state, inputs), state.step};
  sample.actuators.add(*model_, state, inputs);
  return sample;
}

Result<JobResult> Engines::advance_outside(const JobLimits& limits, const std::atomic<bool>& canceled) {
  JobResult outcome;
  const auto end = Clock::now() + std::chrono::duration<double>(limits.seconds);
  const bool shadow_first = shadow_paces();
  const bool both = !shadow_first && !limits.alone && shadowed() && !in_context(shadow_);
  Solver& first = *(shadow_first ? shadow_ : leader_).solver;
  Advanced& paced = shadow_first ? outcome.shadow : outcome.leader;
  State start, other_start;
  if (both) {
    ASPIC_TRY(start, first.state());
    ASPIC_TRY(other_start, shadow_.solver->state());
  }
  std::uint64_t sample = next_sample_step(limits.from, model_->simulation.timestep);
  first.set_stop_flag(&canceled);
  for (std::uint64_t at = limits.from; at < limits.to && Clock::now() < end;) {
    ASPIC_TRY(const Advance advanced, first.advance(1));
    paced.divergence = advanced.divergence;
    if (advanced.divergence || advanced.stopped) break;
    if (++at != sample || limits.alone) continue;
    sample = next_sample_step(sample, model_->simulation.timestep);
    ASPIC_TRY(const auto state, first.state());
    outcome.energies.push_back(measured(state));
  }
  ASPIC_TRY(paced.state, first.state());
  outcome.steps = paced.state.step - limits.from;
  if (both) {
    shadow_.solver->set_stop_flag(&canceled);
    ASPIC_CHECK(advance(shadow_, tried_steps(outcome, paced), outcome.shadow));
    // Where canceling stops the shadow it takes back the steps of both: they stay together.
    if (canceled && !outcome.shadow.divergence &&
        outcome.shadow.state.step - limits.from < tried_steps(outcome, paced)) {
      ASPIC_CHECK(first.load(start));
      ASPIC_CHECK(shadow_.solver->load(other_start));
      outcome.steps = 0;
      outcome.energies.clear();
      outcome.leader = {std::move(start), std::nullopt};
      outcome.shadow = {std::move(other_start), std::nullopt};
    }
  }
  return outcome;
}

Status Engines::follow(JobResult& outcome) {
  if (shadow_paces()) return advance(leader_, tried_steps(outcome, outcome.shadow), outcome.leader);
  if (!in_context(shadow_)) return {};
  return advance(shadow_, tried_steps(outcome, outcome.leader), outcome.shadow);
}

void EngineFactory::set_context(gl::Context& context) {
  context_ = &context;
  arithmetic_.reset();
}

Result<Backend> EngineFactory::make(const SharedModel& model, const BackendRow& row, const GpuSolver* like) {
  auto engine = make_backend(choice_for(&row, asked_), model, {context_, like, arithmetic_});
  if (GpuSolver* const gpu = engine ? gpu_of(*engine) : nullptr) {
    arithmetic_ = gpu->arithmetic();
    gpu->set_late(true);
  }
  return engine;
}

Result<Engines> EngineFactory::make_like(const Engines& like, const Setup& setup) {
  ASPIC_TRY(auto built, build_model(setup));
  return make_like(like, shared(std::move(built)));
}

Result<Engines> EngineFactory::make_like(const Engines& like, const SharedModel& model) {
  auto leader = make(model, *like.leader().row, like.gpu());
  if (leader && like.shadowed()) {
    ASPIC_TRY(auto shadow, make(model, *like.shadow().row, like.gpu()));
    return Engines(model, std::move(*leader), std::move(shadow));
  }
  std::optional<Error> departure;
  if (!leader && Engines::in_context(like.leader())) {
    departure = {leader.error().code,
                 fmt::format("{} The {} takes over.", leader.error().what, contextless_backend().title)};
    leader = make(model, contextless_backend(), nullptr);
  }
  if (!leader) return leader.error();
  Engines engines(model, std::move(*leader), {});
  engines.departure = std::move(departure);
  return engines;
}

}  // namespace aspic
