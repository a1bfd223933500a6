#include "cpu_parallel/steps.h"

#include <cassert>

#include "cpu_parallel/explicit.h"
#include "cpu_parallel/implicit.h"

namespace aspic::parallel {

std::unique_ptr<Steps> make_steps(const StepParts& parts) {
  switch (row_of(parts.model->simulation.integrator).kind()) {
    case MethodKind::staged:
      return std::make_unique<ExplicitSteps>(parts);
    case MethodKind::newton:
      return std::make_unique<ImplicitEuler>(parts);
  }
  assert(false);
  return nullptr;
}

}  // namespace aspic::parallel
