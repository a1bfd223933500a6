#pragma once
// What a kind of methods brings to the parallel solver: steps. What is common to all kinds is in
// cpu_solver.cpp: balls, divergence, statistics. A new kind derives from Steps and is named in make_steps().
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "aspic/solver.h"
#include "cpu_parallel/bands.h"
#include "cpu_parallel/lengths.h"
#include "cpu_parallel/springs.h"
#include "cpu_parallel/workers.h"
#include "cpu_reference/dynamics.h"
#include "model/implicit.h"

namespace aspic::parallel {

/// Calls act(springs) of what every method takes: bands are for explicit ones.
template <class Act>
auto with_springs(const Springs& springs, const Act& act) {
  if (const auto* const lattice = std::get_if<LatticeStencil>(&springs)) return act(*lattice);
  return act(std::get<SpringLists>(springs));
}

/// What steps of any kind work with. Everything must outlive them.
struct StepParts {
  const SharedModel& model;  ///< may become another of the same topology: constants_changed()
  const reference::Dynamics<float>& dynamics;
  const std::vector<Springs>& springs;  ///< by body
  MovingLengths& lengths;               ///< of these springs
  /// By particle, with room of `slice` behind the last.
  const FloatArray &mass, &inverse_mass;
  std::size_t margin;  ///< particles that the springs' loops may read on both sides of an array
  Workers& workers;
};

/// Steps of all particles, one after another. Dynamics::begin_step() comes before each.
class Steps {
 public:
  virtual ~Steps() = default;

  /// A step from `start`, the terrain's response included. Returns whether all particles ended it finite and
  /// slower than the speed that counts as diverged. A method that reports solves fills in the report; a
  /// residual in it that is not finite is a divergence.
  virtual bool step(Particles& start, Particles& end, SolveReport& report) = 0;
  /// Particles were moved since step(): the next one begins at these. Returns as step().
  virtual bool look_at(const Particles& start) = 0;
  /// The next step begins elsewhere than the last one ended.
  virtual void forget() {}
  /// The model has become another of the same topology, and dynamics, springs and masses are those of it.
  virtual void constants_changed() { forget(); }
  /// Bytes that it holds, itself included.
  virtual std::uint64_t bytes() const = 0;
};

/// Steps of the model's integrator.
std::unique_ptr<Steps> make_steps(const StepParts& parts);

}  // namespace aspic::parallel
