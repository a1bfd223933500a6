#pragma once
// The fast CPU solver: threads and vector instructions, with the bits of the reference for any number of
// threads and any instruction set.
#include <memory>

#include "model/solver.h"

namespace aspic {

struct CpuOptions {
  /// Threads, 1 to 1024; 0: as many as there are processors (or ASPIC_THREADS), fewer for scenes too small
  /// for them.
  unsigned threads = 0;
};

/// A parallel solver at the model's initial state, in single precision. Implicit Euler runs on one thread,
/// the reference's. The model must outlive the solver. Error (scene_rejected): there is no memory left for
/// its fields.
Result<std::unique_ptr<Solver>> make_cpu_solver(const Model& model, const CpuOptions& options = {});

/// Bytes a parallel solver of the model holds.
std::uint64_t cpu_bytes(const Model& model);

}  // namespace aspic
