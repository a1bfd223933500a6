#pragma once
// What one thread of a batch steps without meeting others: a model alone, or a stack of models.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "aspic/solver.h"
#include "cpu_parallel/stack_kernels.h"
#include "cpu_parallel/workers.h"

namespace aspic::batch {

/// Instances by slot, from 0. Calls are those of Batch, with numbers that are right.
class Unit {
 public:
  virtual ~Unit() = default;
  virtual std::size_t size() const = 0;
  virtual SharedModel model(std::size_t slot) const = 0;
  virtual std::uint64_t step(std::size_t slot) const = 0;
  virtual std::optional<Divergence> divergence(std::size_t slot) const = 0;
  virtual const Inputs& inputs(std::size_t slot) const = 0;
  /// Until the next call that is not const.
  virtual ConstStateView view(std::size_t slot) const = 0;
  virtual Status load(std::size_t slot, const ConstStateView& view, std::uint64_t step) = 0;
  virtual Status set_inputs(std::size_t slot, const Inputs& inputs) = 0;
  /// False: the instance must go to another unit, and nothing has changed.
  virtual Result<bool> set_constants(std::size_t slot, SharedModel model) = 0;
  /// The instance has gone.
  virtual void retire(std::size_t slot) = 0;
  virtual void set_stop_flag(const std::atomic<bool>* flag) = 0;
  /// All of them, by as many steps as Batch::advance() says.
  virtual Status advance(std::uint64_t steps) = 0;
  /// Those whose threads may help with the pieces of a step; null: none.
  virtual parallel::Workers* helped() const { return nullptr; }
  virtual std::uint64_t bytes() const = 0;
};

/// A cpu solver, of one thread or with helpers. Error (scene_rejected): no memory.
Result<std::unique_ptr<Unit>> make_lone(SharedModel model, std::shared_ptr<parallel::Workers> helpers = {});
/// Models that may be in one stack; `springs`: theirs.
std::unique_ptr<Unit> make_stack(const std::vector<SharedModel>& models,
                                 std::shared_ptr<const parallel::UpperEnds> springs);

/// Time that a step takes, relative to those of other models on one thread.
double cost_of(const Model& model);
/// A stack's step in steps of one of its models alone: 5 for a cube of 6³, 10 for one of 12³ (measured).
double cost_of_stack(const Model& model);

}  // namespace aspic::batch
