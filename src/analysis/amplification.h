#pragma once
// How an integrator amplifies one mode of damped oscillation, ẍ + γẋ + κx = 0, and up to which step it does
// not grow.
#include <complex>
#include <optional>

#include "model/settings.h"

namespace aspic {

/// Largest h with |R(h'λ)| ≤ 1 for all h' in (0, h], where R is the amplification polynomial of a staged
/// (Runge–Kutta) method and λ [1/s] an eigenvalue with Re λ ≤ 0; infinite for λ = 0; nothing where the mode
/// grows at any step. Source: Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, §IV.2. Not
/// for symplectic or implicit Euler.
std::optional<double> eigenvalue_limit(Integrator integrator, std::complex<double> lambda);

/// The same for both eigenvalues of a mode of stiffness per mass κ [1/s²] ≥ 0 and damping per mass γ [1/s] ≥
/// 0, for every integrator. Symplectic Euler: (−γ + √(γ² + 4κ))/κ, from the Jury criterion on its step
/// matrix. Implicit Euler: infinite. κ or γ that overflowed, to infinity or NaN: 0.
std::optional<double> mode_limit(Integrator integrator, double kappa, double gamma);

}  // namespace aspic
