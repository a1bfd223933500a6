#include "aspic/solver.h"

#include <fmt/format.h>

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

std::string_view name_of(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::exact ? "exact" : "fast";
}

}  // namespace aspic
