#include "model/solver.h"

#include <fmt/format.h>

namespace aspic {

std::string body_text(const Divergence& divergence) {
  return fmt::format("{} {}", divergence.ball ? "ball" : "particle", divergence.particle);
}

}  // namespace aspic
