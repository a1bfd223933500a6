#pragma once
// How an integrator amplifies one mode of damped oscillation, ẍ + γẋ + κx = 0, and up to which step it does
// not grow.
#include <array>
#include <complex>
#include <limits>
#include <optional>

#include "model/integrator.h"

namespace aspic {

/// Of steps and times that have no limit [s].
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Coefficients of R(z), lowest first: the stages applied to y' = λy, z = hλ. For velocities it holds for
/// every staged method where forces do not depend on positions.
std::array<double, max_stages + 1> amplification_polynomial(const Staged& method);

/// Largest h with |R(h'λ)| ≤ 1 for all h' in (0, h], where R is the amplification polynomial of a staged
/// (Runge–Kutta) method and λ [1/s] an eigenvalue with Re λ ≤ 0; infinite for λ = 0; nothing where the mode
/// grows at any step. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, §IV.2. Not
/// for methods whose row has a mode_limit.
std::optional<double> eigenvalue_limit(Integrator integrator, std::complex<double> lambda);

/// The same for both eigenvalues of a mode of stiffness per mass κ [1/s²] ≥ 0 and damping per mass γ [1/s] ≥
/// 0, for every integrator that is staged or stable at any step; infinite for the latter. κ or γ that
/// overflowed, to infinity or NaN: 0, unless no step is too large.
std::optional<double> mode_limit(Integrator integrator, double kappa, double gamma);

}  // namespace aspic
