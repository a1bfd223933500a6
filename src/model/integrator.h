#pragma once
// The explicit integrators as a table of stages: adding a Runge–Kutta method means adding a row here.
//
// Stage s evaluates a_s = a(X_s, V_s) with X_0 = x, V_0 = v and
//   X_{s+1} = x + (h·advance_s)·V_s,   V_{s+1} = v + (h·advance_s)·a_s;
// the step ends with
//   x' = x + (h/divisor)·Σ weight_s·V_s,   v' = v + (h/divisor)·Σ weight_s·a_s,
// where sums run in stage order from the first stage whose weight is not zero. Source: Butcher, Numerical
// Methods for Ordinary Differential Equations, 2016, §230, for methods whose stages each need only the one
// before.
#include <span>

#include "model/settings.h"

namespace aspic {

struct Stage {
  double advance =
      0.0;  ///< fraction of h from the start of the step to the next stage; unused in the last stage
  double weight = 0.0;  ///< small integer, exact in any precision
};

struct StagedMethod {
  std::span<const Stage> stages;
  double divisor = 1.0;                     ///< of the weights
  bool position_from_new_velocity = false;  ///< symplectic Euler: x' = x + h·v'
};

/// Largest number of stages in the table.
inline constexpr int max_stages = 4;

/// The table's row; nothing for implicit_euler, which is solved, not staged.
const StagedMethod* staged_method(Integrator integrator);

/// Force evaluations one step takes (explicit methods).
int force_evaluations_per_step(Integrator integrator);

}  // namespace aspic
