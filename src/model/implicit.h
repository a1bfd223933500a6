#pragma once
// Implicit Euler: the constants of the solve that every backend shares, and what it reports.
#include <cstdint>

#include "model/settings.h"
#include "model/state.h"

namespace aspic {

/// How a step's solve ended, spec §2.6.
enum class SolveEnd : std::uint32_t { converged = 0, stagnated = 1, not_converged = 2 };

/// One step's solve.
struct SolveReport {
  std::uint32_t newton_iterations = 0;  ///< linear systems solved
  std::uint32_t cg_iterations = 0;      ///< of all of them
  double residual = 0.0;                ///< max over particles and components of |(v' − v) − h·a| [m/s]
  SolveEnd end = SolveEnd::converged;
};

/// A run's solves since the state was loaded.
struct SolveStatistics {
  std::uint64_t steps = 0, converged = 0, stagnated = 0, not_converged = 0;
  std::uint64_t newton_iterations = 0, cg_iterations = 0;
  double worst_residual = 0.0;  ///< [m/s]
  SolveReport last;             ///< of the latest step

  void add(const SolveReport& report);
};

/// Tolerance on the residual [m/s]: the scene's, or 1e-4 in single and 1e-9 in double precision.
double implicit_tolerance(const ImplicitSettings& settings, Precision precision);

/// A linear system is solved until r·z fell below this fraction of its first value: the square of the forcing
/// term η = 0.01 of an inexact Newton method (Dembo, Eisenstat, Steihaug, SIAM J. Numer. Anal. 19, 1982).
inline constexpr double cg_reduction = 1e-4;
/// Newton's step is halved at most this often before the line search gives up.
inline constexpr int max_halvings = 8;
/// Newton iterations without a smaller residual that end a step as stagnated.
inline constexpr int max_without_progress = 3;

}  // namespace aspic
