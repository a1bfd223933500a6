#pragma once
// What else there is to say of the largest stable time step (docs/physics.md, section 3).
//
// stability_limit() linearizes springs at rest, actuated ones with their shortest rest length, by a bound.
// Where all springs of a body have one ratio of damping to stiffness, its modes are those of one operator
// with eigenvalues α in (0, α_max], each giving λ² + (αc/m)λ + αk/m = 0: the limit is the minimum over that
// interval, exact where α_max itself decides. Otherwise symplectic Euler's limit is the h with λ_max(h²K +
// 2hC) = 4, exact; the others' is exact by a dense solve where the body is small, and else the minimum over
// all (κ, γ) that Rayleigh quotients of K and C can take. The work is a budget of spring evaluations, about a
// second's for quick and ten seconds' for thorough; bodies for which nothing is left take part with
// Gershgorin bounds on κ and γ.
#include <optional>
#include <string>

#include "aspic/analysis.h"
#include "model/model.h"

namespace aspic {

/// Largest eigenvalue α of the infinite cube lattice with all spring constants and masses 1: the maximum over
/// wave vectors of Σ 2(1 − cos θ·d)·nnᵀ, rounded up. A cube has springs missing at its surface, which only
/// lowers it.
inline constexpr double infinite_lattice_eigenvalue = 17.6334;

/// True if `timestep` is stable beyond doubt, from the infinite lattice alone and in no time: cubes with one
/// ratio of damping to stiffness. False says nothing: ask stability_limit.
bool certainly_stable(const Model& model, Integrator integrator, double timestep);

/// Largest eigenvalue κ_max [1/s²] of M^(-1/2) K M^(-1/2) over all bodies: α_max·k/m for a uniform cube,
/// whose α_max is 16.850 at n = 10.
double largest_stiffness_eigenvalue(const Model& model);

/// Whether a time step [s] is above the limit. A bound that is not exact counts: the warning is then a
/// caution.
bool exceeds(double timestep, const StabilityLimit& limit);

/// "0.002048 s", "at least 0.0013 s", "none", "any".
std::string stability_figure(const StabilityLimit& limit);

/// "the largest stable one for explicit-euler is estimated at 0.002048 s", or "is at least …" where that is
/// all that is known: part of a sentence.
std::string stability_sentence(Integrator integrator, const StabilityLimit& limit);

/// What to do about the time step [s] of a run that diverged: "The time step is 0.02 s; the largest stable
/// one … 0.002048 s." The limit holds for small motions: below it a hit or a contact was too much, and the
/// sentence says that and names half the step.
std::string divergence_sentence(double timestep, Integrator integrator, const StabilityLimit& limit);

/// The time step [s] to offer to a run that diverged, always below its own: 0.95 of the limit, rounded down
/// to two digits, or half its own step where that is below the limit already. Nothing where no step is
/// stable.
std::optional<double> step_to_try(double timestep, const StabilityLimit& limit);

/// The largest step of one digit, 1, 2 or 5, below half the largest stable one [s]; `otherwise` where there
/// is no limit or no step is stable.
double usual_timestep(const StabilityLimit& limit, double otherwise);

/// "the time step 0.01 s is not stable: …." or "may not be stable", for a step that exceeds the limit.
std::string unstable_sentence(double timestep, Integrator integrator, const StabilityLimit& limit);

}  // namespace aspic
