#include "batch/unit.h"

#include <utility>

#include "base/flush_denormals.h"
#include "base/result.h"
#include "cpu_parallel/cpu_solver.h"
#include "cpu_parallel/stack.h"
#include "model/counts.h"
#include "model/inputs.h"
#include "model/integrator.h"
#include "model/springs.h"

namespace aspic::batch {
namespace {

class Lone final : public Unit {
 public:
  Lone(SharedModel model, std::unique_ptr<Solver> solver, std::shared_ptr<parallel::Workers> helpers)
      : model_(std::move(model)), solver_(std::move(solver)), helpers_(std::move(helpers)) {}

  std::size_t size() const override { return 1; }
  SharedModel model(std::size_t) const override { return model_; }
  std::uint64_t step(std::size_t) const override { return step_; }
  std::optional<Divergence> divergence(std::size_t) const override { return divergence_; }
  const Inputs& inputs(std::size_t) const override { return solver_->inputs(); }
  ConstStateView view(std::size_t) const override { return *solver_->view(); }

  Status load(std::size_t, const ConstStateView& view, std::uint64_t step) override {
    ASPIC_CHECK(solver_->load(view, step));
    step_ = step;
    divergence_.reset();
    return {};
  }
  Status set_inputs(std::size_t, const Inputs& inputs) override { return solver_->set_inputs(inputs); }
  Result<bool> set_constants(std::size_t, SharedModel model) override {
    ASPIC_CHECK(solver_->set_constants(model));
    ASPIC_TRY(step_, solver_->read_into({}));
    model_ = std::move(model);
    divergence_.reset();
    return true;
  }
  void retire(std::size_t) override {}
  void set_stop_flag(const std::atomic<bool>* flag) override { solver_->set_stop_flag(flag); }

  Status advance(std::uint64_t steps) override {
    ASPIC_TRY(const Advance advanced, solver_->advance(steps));
    divergence_ = advanced.divergence;
    step_ += advanced.steps;
    return {};
  }
  parallel::Workers* helped() const override { return helpers_.get(); }
  std::uint64_t bytes() const override { return sizeof(*this) + solver_->bytes(); }

 private:
  SharedModel model_;
  std::unique_ptr<Solver> solver_;
  std::shared_ptr<parallel::Workers> helpers_;
  std::uint64_t step_ = 0;
  std::optional<Divergence> divergence_;
};

class Stacked final : public Unit {
 public:
  Stacked(const std::vector<SharedModel>& models, std::shared_ptr<const parallel::UpperEnds> springs)
      : stack_(models, std::move(springs)), inputs_(models.size()) {}

  std::size_t size() const override { return inputs_.size(); }
  SharedModel model(std::size_t slot) const override { return stack_.model(slot); }
  std::uint64_t step(std::size_t slot) const override { return stack_.step(slot); }
  std::optional<Divergence> divergence(std::size_t slot) const override { return stack_.divergence(slot); }
  const Inputs& inputs(std::size_t slot) const override { return inputs_[slot]; }
  ConstStateView view(std::size_t slot) const override { return stack_.view(slot); }

  Status load(std::size_t slot, const ConstStateView& view, std::uint64_t step) override {
    ASPIC_CHECK(check_sizes(*model(slot), view, true));
    ASPIC_CHECK(check_finite(view, Precision::single));
    stack_.load(slot, view, step);
    return {};
  }
  Status set_inputs(std::size_t slot, const Inputs& inputs) override {
    ASPIC_TRY(Inputs rounded, rounded_inputs(*model(slot), inputs, Precision::single));
    if (rounded == inputs_[slot]) return {};
    stack_.set_inputs(slot, rounded);
    inputs_[slot] = std::move(rounded);
    return {};
  }
  Result<bool> set_constants(std::size_t slot, SharedModel next) override {
    ASPIC_CHECK(check_same_topology(*model(slot), *next));
    if (const auto taken = rounded_inputs(*next, inputs_[slot], Precision::single); !taken)
      return taken.error();
    if (!parallel::Stack::same(*model(slot), *next)) return false;
    stack_.set_constants(slot, std::move(next), inputs_[slot]);
    return true;
  }
  void retire(std::size_t slot) override { stack_.retire(slot); }
  void set_stop_flag(const std::atomic<bool>* flag) override { flag_ = flag; }

  Status advance(std::uint64_t steps) override {
    const FlushDenormals flush;
    for (std::uint64_t n = 0; n < steps && stack_.any_runs(); ++n) {
      if (flag_ && flag_->load(std::memory_order_relaxed)) break;
      stack_.advance();
    }
    return {};
  }
  std::uint64_t bytes() const override { return sizeof(*this) + stack_.bytes(); }

 private:
  parallel::Stack stack_;
  std::vector<Inputs> inputs_;
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace

Result<std::unique_ptr<Unit>> make_lone(SharedModel model, std::shared_ptr<parallel::Workers> helpers) {
  CpuOptions options;
  options.threads = 1;
  options.workers = helpers;
  ASPIC_TRY(auto solver, make_cpu_solver(model, options));
  return std::unique_ptr<Unit>(
      std::make_unique<Lone>(std::move(model), std::move(solver), std::move(helpers)));
}

std::unique_ptr<Unit> make_stack(const std::vector<SharedModel>& models,
                                 std::shared_ptr<const parallel::UpperEnds> springs) {
  return std::make_unique<Stacked>(models, std::move(springs));
}

double cost_of(const Model& model) {
  const auto evaluations = force_evaluations_per_step(model.simulation.integrator);
  // A step of implicit Euler takes tens of evaluations; balls search the particles around them.
  const double springs = static_cast<double>(spring_count(model) + model.particle_count());
  return springs * (evaluations > 0 ? evaluations : 30.0) + 1000.0 * model.ball_count();
}

double cost_of_stack(const Model& model) {
  return 4.5 + 0.003 * model.particle_count();
}

}  // namespace aspic::batch
