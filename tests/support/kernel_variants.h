#pragma once
// What solvers have to be made of so that every kernel is compiled with every set of defines in use.
#include <string>
#include <vector>

#include "gpu_solver/gpu_solver.h"
#include "model/model.h"

namespace aspic::test {

/// A solver, and a run in which what its kernels compute shows in the state.
struct KernelVariant {
  std::string scene;  ///< in words; variants of one scene have one model
  ModelSettings settings;
  GpuOptions options;

  std::uint64_t steps() const;
};

/// Methods of one stage, of several and the solved one on every terrain, on several and on one that moves; on
/// all paths, alone, with a body of listed springs and with actuators; stages in one pass and in two; bodies
/// of cells; both forms of the kernels of lattices; few balls, and many by either search; group sizes; exact,
/// fast and corrected arithmetic. What a scene has otherwise, such as its contact model or table of stages,
/// kernels read at run time.
const std::vector<KernelVariant>& kernel_variants();

}  // namespace aspic::test
