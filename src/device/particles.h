#pragma once
// States as kernels and images hold them, in single precision.
#include <span>
#include <vector>

#include "aspic/solver.h"
#include "aspic/state_view.h"
#include "device/layout.h"
#include "model/model.h"

namespace aspic {

/// Rounded to single precision.
layout::vec4 rounded(const Vec3& v, double w);
layout::SpringClass rounded(const SpringClass& spring);

/// The particles of a state, rounded. The state must have the model's number of particles.
std::vector<layout::Particle> packed_particles(const Model& model, const ConstStateView& state);
inline std::vector<layout::Particle> packed_particles(const Model& model, const State& state) {
  return packed_particles(model, view_of(state));
}

/// The balls of a state at a step, rounded: those that wait for their launch have no inverse mass. The state
/// must have the model's number of balls.
std::vector<layout::Ball> packed_balls(const Model& model, const ConstStateView& state, std::uint64_t step);
inline std::vector<layout::Ball> packed_balls(const Model& model, const State& state) {
  return packed_balls(model, view_of(state), state.step);
}

/// Reads a solver's state as packed_particles() and packed_balls() have it, without a State in between, and
/// returns its step. The spans have the model's sizes. Errors: those of Solver::read_into().
Result<std::uint64_t> read_packed(Solver& solver, std::span<layout::Particle> particles,
                                  std::span<layout::Ball> balls);

/// Writes the fields of particles, the first of which is number `first` of the view, or of balls, that the
/// view has places for.
void unpack(std::span<const layout::Particle> particles, const StateView& view, std::size_t first = 0);
void unpack(std::span<const layout::Ball> balls, const StateView& view);

}  // namespace aspic
