#pragma once
// What a kind of methods brings to the reference: steps, and the memory they take. What is common to all
// kinds is in reference_solver.cpp: balls, divergence, statistics. A new kind derives from Method and is
// named in kind_row().
#include <cstdint>
#include <memory>

#include "aspic/solver.h"
#include "base/flush_denormals.h"
#include "cpu_reference/integrators.h"
#include "model/implicit.h"
#include "model/integrator.h"

namespace aspic::reference {

/// Steps of all particles, one after another. Dynamics::begin_step() comes before each.
template <class T>
class Method {
 public:
  virtual ~Method() = default;

  /// The end of a step from `s`, before the terrain's response. A method that reports solves fills in the
  /// report; a residual in it that is not finite is a divergence.
  virtual Phase<T> step(const Phase<T>& s, SolveReport& report) = 0;

  /// The terrain's response at the end of the step from `s` that step() was last asked for.
  virtual void respond(const Phase<T>& s, Phase<T>& end) const = 0;
};

/// A kind of methods.
template <class T>
struct KindRow {
  /// The method of the model's integrator. Both arguments must outlive it.
  std::unique_ptr<Method<T>> (*make)(const Dynamics<T>& dynamics, const Model& model);
  /// Bytes that it holds at most in a step, in addition to where the step starts and ends.
  std::uint64_t (*bytes)(const Model& model);
};

template <class T>
KindRow<T> kind_row(MethodKind kind);

/// A reference solver at the model's initial state, with methods of this kind whatever the model's integrator
/// is. make_reference_solver() calls it with the kind of that integrator.
template <class T>
std::unique_ptr<Solver> solver_with(const KindRow<T>& kind, SharedModel model,
                                    Denormals denormals = Denormals::flushed);

// Compiled once, in method.cpp and reference_solver.cpp.
extern template KindRow<float> kind_row(MethodKind);
extern template KindRow<double> kind_row(MethodKind);
extern template std::unique_ptr<Solver> solver_with(const KindRow<float>&, SharedModel, Denormals);
extern template std::unique_ptr<Solver> solver_with(const KindRow<double>&, SharedModel, Denormals);

}  // namespace aspic::reference
