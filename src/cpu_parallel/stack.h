#pragma once
// A stack: up to 16 models with the same springs that make their steps together, one in each lane of the
// vector registers, on one thread. For many small models: nothing is masked, gathered or evaluated twice, and
// their springs are walked once for all. Each has the bits that it has alone.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "aspic/solver.h"
#include "cpu_parallel/stack_kernels.h"
#include "cpu_reference/dynamics.h"

namespace aspic::parallel {

class Stack {
 public:
  /// Whether a model may be in one: its method is staged, it has particles, not too many for a cache, no
  /// balls and no bodies that touch.
  static bool takes(const Model& model);
  /// Whether two that may be in one may be in the same: their topology and time step are equal.
  static bool same(const Model& a, const Model& b);

  /// 1 to stack_lanes models that may be in one stack, at their initial states; `springs`: theirs.
  Stack(const std::vector<SharedModel>& models, std::shared_ptr<const UpperEnds> springs);

  const SharedModel& model(std::size_t lane) const { return lanes_[lane].model; }
  std::uint64_t step(std::size_t lane) const { return lanes_[lane].step; }
  const std::optional<Divergence>& divergence(std::size_t lane) const { return lanes_[lane].divergence; }
  /// Where the state lies; after a divergence the last good one.
  ConstStateView view(std::size_t lane) const;
  /// A state of the model's sizes; a divergence is forgotten.
  void load(std::size_t lane, const ConstStateView& view, std::uint64_t step);
  /// Inputs that rounded_inputs() returned for the model.
  void set_inputs(std::size_t lane, const Inputs& inputs);
  /// Another model that is the same() and takes these inputs.
  void set_constants(std::size_t lane, SharedModel model, const Inputs& inputs);
  /// The lane is of no use from here on.
  void retire(std::size_t lane);

  /// A step of each that has not diverged.
  void advance();
  /// Whether there is one.
  bool any_runs() const { return running_ != 0; }
  /// Bytes it holds, the springs apart.
  std::uint64_t bytes() const;

 private:
  struct Lane {
    SharedModel model;
    reference::Dynamics<float> dynamics;
    std::uint64_t step = 0;
    std::optional<Divergence> divergence;
    std::vector<float> kept;  ///< the last good state after a divergence: x and v, component by component
    std::vector<physics::RestingContact<float>> resting;  ///< of this step, in ascending particle index
    bool pins_held = false;                               ///< no pinned particle moves
    std::optional<RestLengths> lengths;                   ///< of actuated springs; none without them
    explicit Lane(SharedModel of) : model(std::move(of)), dynamics(*model) {}
  };
  template <class F>
  void for_running(const F& f);
  std::size_t at(std::size_t particle, std::size_t lane) const { return particle * stack_lanes + lane; }

  void take_constants(std::size_t lane);
  void take_lengths(double share);
  void take_masses(std::size_t lane, const Inputs& inputs);
  void still(std::size_t lane);
  void hold_pins(Lane& lane, std::size_t index);
  void find_near(const VectorArray& x);
  void find_resting();
  void add_pulls(const Particles& where);
  void add_contact(const Particles& where);
  bool respond();
  void settle(bool sound);

  const std::size_t particles_;
  const std::shared_ptr<const UpperEnds> springs_;
  std::vector<Lane> lanes_;
  std::uint32_t running_ = 0;  ///< a bit for each lane that has not diverged
  Particles state_, next_, between_, sums_;
  VectorArray force_;
  FloatArray mass_, inverse_mass_, constants_;
  std::array<physics::BodyForce<float>, stack_lanes> body_forces_;
  std::vector<Front> fronts_;  ///< by terrain
  std::vector<NearRow> near_;  ///< at the step's start
  bool known_ = false;         ///< `near_` is up to date
};

}  // namespace aspic::parallel
