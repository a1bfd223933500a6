#pragma once
// Stability as a solver shows it: whether small motions of a body alone in space grow from step to step.
// analysis/stability.h has the answer of the linearized equations.
#include <functional>
#include <memory>

#include "aspic/solver.h"
#include "base/result.h"
#include "model/model.h"

namespace aspic {

/// A model's bodies without gravity, terrain and balls; cords, which theory takes as stretched, resist
/// compression too, and implicit solves are as accurate as single precision allows.
Model alone_in_space(Model model);

/// The same model with all stiffnesses and dampings multiplied, and a time step [s].
Model with_constants(Model model, double stiffness_factor, double damping_factor, double timestep);

/// A start for probes in single precision: the first body displaced by a thousandth of its shortest spring in
/// its stiffest modes of stiffness and of damping, and by a tenth of that at random; the other bodies where
/// they are. The first body is at the origin, where coordinates are finest.
struct ProbeStart {
  State rest, displaced;
};
/// The model is one of alone_in_space(); scaling its constants does not change its start.
ProbeStart probe_start(const Model& model);

/// Whether the motion grows in `steps` steps, ≥ 30: by amplitudes in the last third against the first. The
/// solver's model has the start's particles. Errors: the solver's.
Result<bool> grows(Solver& solver, const ProbeStart& start, std::uint64_t steps);

/// Makes a solver of a model, which need not outlive it.
using MakeSolver = std::function<Result<std::unique_ptr<Solver>>(const Model&)>;

/// The largest step [s] at which nothing grows, by bisection between `low` and `high` to a relative
/// `tolerance`; `low` where already that grows, `high` where nothing does. Errors: the solver's.
Result<double> measured_limit(const Model& model, const ProbeStart& start, const MakeSolver& make, double low,
                              double high, double tolerance, std::uint64_t steps);

}  // namespace aspic
