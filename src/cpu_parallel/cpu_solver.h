#pragma once
// The parallel CPU solver: threads and vector instructions, with the bits of the
// reference for any number of threads and any instruction set.
#include <memory>
#include <utility>

#include "aspic/solver.h"
#include "model/model.h"

namespace aspic {

namespace parallel {
class Workers;
}

struct CpuOptions {
  /// Threads, 1 to 1024; 0: as many as there are processors (or ASPIC_THREADS), fewer for scenes too small
  /// for them.
  unsigned threads = 0;
  /// Others' threads; null: the solver starts some.
  std::shared_ptr<parallel::Workers> workers = nullptr;
};

/// A parallel solver at the model's initial state, in single precision. Errors: usage where ASPIC_THREADS is
/// no number of threads; scene_rejected where there is no memory left for its fields.
Result<std::unique_ptr<Solver>> make_cpu_solver(SharedModel model, const CpuOptions& options = {});
/// With a model of its own: a copy, or what is moved here.
inline Result<std::unique_ptr<Solver>> make_cpu_solver(Model model, const CpuOptions& options = {}) {
  return make_cpu_solver(shared(std::move(model)), options);
}

}  // namespace aspic
