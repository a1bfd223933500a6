#include "app/engines.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace aspic::app {
namespace {

Status advance(const Backend& engine, std::uint64_t steps, Advanced& into) {
  ASPIC_TRY(const auto advanced, engine.solver->advance(steps));
  ASPIC_TRY(auto state, engine.solver->state());
  into.divergence = advanced;
  into.state = std::move(state);
  return {};
}

/// A step that failed on one side is tried on the other.
std::uint64_t tried_steps(const Outcome& outcome, const Advanced& paced) {
  return outcome.steps + (paced.divergence ? 1 : 0);
}

}  // namespace

Engines& Engines::operator=(Engines&& other) noexcept {
  leader_ = std::move(other.leader_);
  shadow_ = std::move(other.shadow_);
  model_ = std::move(other.model_);
  return *this;
}

Status Engines::load(const State& state) {
  ASPIC_CHECK(leader_.solver->load(state));
  return shadowed() ? shadow_.solver->load(state) : Status();
}

Status Engines::set_pull(const std::optional<Pull>& pull) {
  ASPIC_CHECK(leader_.solver->set_pull(pull));
  return shadowed() ? shadow_.solver->set_pull(pull) : Status();
}

Outcome Engines::advance_outside(std::uint64_t steps, double budget, bool alone,
                                 const std::atomic<bool>& hurry) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(budget);
  Outcome outcome;
  const Backend& first = shadow_paces() ? shadow_ : leader_;
  Advanced& paced = shadow_paces() ? outcome.shadow : outcome.leader;
  while (outcome.steps < steps && !hurry && Clock::now() < end) {
    const auto advanced = first.solver->advance(1);
    if (!advanced) {
      outcome.error = advanced.error();
      return outcome;
    }
    paced.divergence = *advanced;
    if (paced.divergence) break;
    ++outcome.steps;
  }
  auto state = first.solver->state();
  if (!state) {
    outcome.error = state.error();
    return outcome;
  }
  paced.state = std::move(*state);
  outcome.measures = measure(*model_, paced.state);
  if (alone || &first == &shadow_ || !shadowed() || in_context(shadow_)) return outcome;
  if (const Status followed = advance(shadow_, tried_steps(outcome, paced), outcome.shadow); !followed)
    outcome.error = followed.error();
  return outcome;
}

Status Engines::follow(Outcome& outcome) {
  if (shadow_paces()) return advance(leader_, tried_steps(outcome, outcome.shadow), outcome.leader);
  if (!in_context(shadow_)) return {};
  return advance(shadow_, tried_steps(outcome, outcome.leader), outcome.shadow);
}

Result<State> Engines::advance_shadow(std::uint64_t steps) {
  Advanced other;
  ASPIC_CHECK(advance(shadow_, steps, other));
  return std::move(other.state);
}

void EngineFactory::set_context(gl::Context& context) {
  context_ = &context;
  arithmetic_.reset();
}

Result<Backend> EngineFactory::make(const Model& model, const BackendRow& row, const GpuSolver* like) {
  auto engine = make_backend(choice_for(&row, asked_), model, {context_, like, arithmetic_});
  if (engine && engine->gpu) arithmetic_ = engine->gpu->arithmetic();
  return engine;
}

Result<Engines> EngineFactory::make_like(const Engines& like, const Setup& setup,
                                         std::optional<std::string>& message) {
  ASPIC_TRY(auto built, build_model(setup));
  auto model = std::make_unique<Model>(std::move(built));
  auto leader = make(*model, *like.leader().row, like.gpu());
  if (!leader && Engines::in_context(like.leader())) {
    message = fmt::format("{} The reference takes over.", leader.error().message);
    leader = make(*model, reference_backend(), nullptr);
  } else if (leader && like.shadowed()) {
    ASPIC_TRY(auto shadow, make(*model, *like.shadow().row, like.gpu()));
    return Engines(std::move(model), std::move(*leader), std::move(shadow));
  }
  if (!leader) return leader.error();
  return Engines(std::move(model), std::move(*leader), {});
}

}  // namespace aspic::app
