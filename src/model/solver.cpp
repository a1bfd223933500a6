#include "aspic/solver.h"

#include <fmt/format.h>

#include <utility>

#include "base/result.h"
#include "model/counts.h"
#include "model/inputs.h"
#include "model/reading.h"

namespace aspic {

Solver::~Solver() = default;

std::string body_text(const Divergence& divergence) {
  if (divergence.residual) return "the residual of the implicit solve";
  return fmt::format("{} {}", divergence.ball ? "ball" : "particle", divergence.particle);
}

std::string fault_text(const Divergence& divergence) {
  return divergence.finite ? fmt::format("became faster than {} m/s", divergence_speed)
                           : "is no longer a finite number";
}

Status Solver::load(const State& state) {
  ASPIC_CHECK(check_sizes(model(), state));
  return load(view_of(state), state.step);
}

Status Solver::load(const ConstStateView& view, std::uint64_t step) {
  ASPIC_CHECK(check_sizes(model(), view, true));
  ASPIC_CHECK(check_finite(view, precision()));
  return take_state(view, step);
}

Result<State> Solver::state() {
  State state;
  ASPIC_CHECK(read_state(*this, state));
  return state;
}

Status read_state(Solver& solver, State& into) {
  into.precision = solver.precision();
  resize(into, solver.model().particle_count(), solver.model().ball_count());
  ASPIC_TRY(into.step, solver.read_into(view_of(into)));
  return {};
}

Result<std::uint64_t> Solver::read_into(const StateView& view) {
  ASPIC_CHECK(check_sizes(model(), view));
  return give_state(view);
}

Status Solver::set_inputs(const Inputs& inputs) {
  ASPIC_TRY(Inputs rounded, rounded_inputs(model(), inputs, precision()));
  if (rounded == inputs_) return {};
  ASPIC_CHECK(take_inputs(rounded));
  inputs_ = std::move(rounded);
  return {};
}

Status Solver::set_constants(SharedModel next) {
  ASPIC_CHECK(check_same_topology(model(), *next));
  if (const auto taken = rounded_inputs(*next, inputs_, precision()); !taken) return taken.error();
  const double from = model().simulation.timestep, to = next->simulation.timestep;
  ASPIC_TRY(const std::uint64_t step, give_state({}));
  return take_constants(std::move(next), step_at_same_time(step, from, to));
}

std::string_view name_of(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::exact ? "exact" : "fast";
}

}  // namespace aspic
