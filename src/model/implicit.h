#pragma once
// Implicit Euler: the constants of the solve that every backend shares.
#include "aspic/settings.h"
#include "aspic/solver.h"
#include "aspic/state.h"

namespace aspic {

/// Tolerance on the residual [m/s]: the scene's, or 1e-4 in single and 1e-9 in double precision.
double implicit_tolerance(const ImplicitSettings& settings, Precision precision);

/// A linear system is solved until √(r·z) fell below η times its first value, the forcing term of an inexact
/// Newton method. The step's first system takes `first_forcing`, every later one η = forcing_factor·|R|²/|R
/// before|², held between least_forcing and most_forcing: no digits are computed that the next residual would
/// not keep, and where rounding stops the residual the systems end at once. Source: Eisenstat and Walker,
/// SIAM J. Sci. Comput. 17, 1996, choice 2 with γ = 0.9, α = 2.
inline constexpr double first_forcing = 0.1;
inline constexpr double forcing_factor = 0.9;
inline constexpr double least_forcing = 0.05;
inline constexpr double most_forcing = 0.5;
/// Newton's step is halved at most this often before the line search gives up.
inline constexpr int max_halvings = 4;
/// Newton iterations without a smaller residual that end a step as stagnated. Smaller means below this share
/// of the smallest before: differences of rounding are no progress.
inline constexpr int max_without_progress = 3;
inline constexpr double progress_share = 0.5;
/// The same where the ground holds particles: which of them it holds is found iteration by iteration, and
/// friction's dependence on the load is left out of the matrix, so that progress comes in smaller and fewer
/// steps.
inline constexpr int max_without_progress_on_ground = 5;
inline constexpr double progress_share_on_ground = 0.9;
/// Least share of a turn of the slip that friction leaves in the matrix, which has to stay finite.
inline constexpr double least_turn = 1e-3;
/// Terrain normals with a smaller sine² between two, or a smaller squared volume of three, count as one
/// surface less: the direction they would leave is rounding.
inline constexpr double least_wedge = 1e-6;
/// Terrains that face the same way (least_wedge) and hold a particle at distances less than this share of ε
/// apart are one surface to it. A power of two, so that the product is exact.
inline constexpr double same_surface_share = 1.0 / 1024.0;

}  // namespace aspic
