#pragma once
// Steps of the explicit methods for the parallel solver: springs, contact and a stage of the method in one
// pass over the particles, the terrain's response at its end.
#include <vector>

#include "cpu_parallel/implicit.h"
#include "cpu_parallel/lattice_kernels.h"
#include "cpu_parallel/workers.h"
#include "cpu_reference/dynamics.h"

namespace aspic::parallel {

class ExplicitSteps {
 public:
  /// Everything must outlive this. `springs`: by body; `mass` and `inverse_mass`: by particle, with room of
  /// `slice` behind the last; `margin`: particles that the springs' loops may read on both sides of an array.
  ExplicitSteps(const Model& model, const reference::Dynamics<float>& dynamics,
                const std::vector<Springs>& springs, const FloatArray& mass, const FloatArray& inverse_mass,
                std::size_t margin, Arithmetic arithmetic, Workers& workers);

  /// A step from `start`, the terrain's response included. Returns whether all particles ended it finite and
  /// slower than the speed that counts as diverged.
  bool step(Particles& start, Particles& end);
  /// What the next step begins at was changed since the last one. Returns as step().
  bool look_at(const Particles& start);
  /// The same without a look: the next step will.
  void forget() { known_ = false; }
  /// Bytes it holds on the heap.
  std::uint64_t bytes() const;

 private:
  /// Consecutive particles of one body that one thread moves: complete planes of a cube, or a piece of any
  /// other body.
  struct Task {
    std::size_t body;
    Range range;  ///< within all particles
    Box box;      ///< around them at the stage at hand
    bool sound;   ///< at the end of the step
    /// Those that may be near terrain at the step's start: at its end terrain moves none but them.
    std::vector<Range> near;
    std::vector<reference::RestingContact<float>> resting;  ///< of this step, in ascending particle index
  };

  void cut(std::size_t body);
  void run(Task& task, const StageMove& stage);
  void finish(Task& task, const StageMove& stage, bool near, Range range, const Forces& forces, Moved& moved);
  void pull(const StageMove& stage, Range range, const Forces& forces);
  void add_contact(Task& task, const StageMove& stage, Range range, const Forces& forces);
  void respond(Task& task, const StageMove& stage);
  void find_near(Task& task, const VectorArray& x) const;
  void find_resting(Task& task, const StageMove& stage) const;
  template <class F>
  void for_near(const VectorArray& x, Range range, const F& f) const;

  const Model& model_;
  const IntegratorRow& method_;
  const reference::Dynamics<float>& dynamics_;
  const std::vector<Springs>& springs_;
  const FloatArray &mass_, &inverse_mass_;
  Arithmetic arithmetic_;
  Workers& workers_;
  std::vector<Task> tasks_;
  std::vector<Sweep> sweeps_;  // by thread
  Particles between_, sums_;
  bool known_ = false;  ///< the boxes, and what is near
};

}  // namespace aspic::parallel
