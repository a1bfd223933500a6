#pragma once
// Two solvers of one model, step by step, and how far they differ.
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "aspic/analysis.h"
#include "aspic/solver.h"
#include "base/result.h"

namespace aspic {

/// The largest difference of a quantity over all steps compared.
struct WorstDifference : QuantityDifference {
  std::uint64_t absolute_step = 0, ulp_step = 0;

  void take(const QuantityDifference& d, std::uint64_t step);
};

/// What is compared, in the order of LockstepResult::worst.
inline constexpr std::array compared_quantities = {
    &StateDifference::position, &StateDifference::velocity, &StateDifference::ball_position,
    &StateDifference::ball_velocity, &StateDifference::ball_angular_velocity};

struct LockstepResult {
  std::uint64_t steps = 0;  ///< compared
  std::array<WorstDifference, compared_quantities.size()> worst;
  std::optional<std::uint64_t> first_difference;        ///< step
  std::array<std::string, 2> hash;                      ///< of the last states compared
  std::array<std::optional<Divergence>, 2> divergence;  ///< ends the comparison
  bool interrupted = false;

  double largest_absolute() const;
};

/// Advances both from where they are, a step at a time, and compares their states before the first step and
/// after each. Until it has seen that a step of the first leaves the second's state alone, it looks: two
/// solvers that write into one state would agree, whatever they compute. `go_on` is told the steps done and
/// says whether to continue. Both have the same `inputs`, by the first one's step number. Errors: those of
/// the solvers; usage: their models have another number of particles or balls; check_failed: both work on one
/// state.
Result<LockstepResult> compare_in_lockstep(Solver& first, Solver& second, std::uint64_t steps,
                                           const std::function<bool(std::uint64_t)>& go_on,
                                           const InputLog& inputs = {});

}  // namespace aspic
