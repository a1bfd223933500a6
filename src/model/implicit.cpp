#include "model/implicit.h"

#include <algorithm>

namespace aspic {

double implicit_tolerance(const ImplicitSettings& settings, Precision precision) {
  return settings.tolerance.value_or(precision == Precision::single ? 1e-4 : 1e-9);
}

void SolveStatistics::add(const SolveReport& report) {
  ++steps;
  converged += report.end == SolveEnd::converged;
  stagnated += report.end == SolveEnd::stagnated;
  not_converged += report.end == SolveEnd::not_converged;
  newton_iterations += report.newton_iterations;
  cg_iterations += report.cg_iterations;
  worst_residual = std::max(worst_residual, report.residual);
  last = report;
}

}  // namespace aspic
