#pragma once
// A backend whose steps never end by themselves: for what the window must do while a step takes long.
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "cpu_reference/reference_solver.h"
#include "run/backends.h"
#include "run/window_host.h"

namespace aspic::test {

/// The reference with steps that last until they are interrupted, and are dropped then.
class Endless : public Solver {
 public:
  explicit Endless(std::unique_ptr<Solver> inner) : inner_(std::move(inner)) {}
  std::string_view backend() const override { return "endless"; }
  std::string description() const override { return "endless"; }
  Precision precision() const override { return inner_->precision(); }
  const Model& model() const override { return inner_->model(); }
  std::uint64_t bytes() const override { return inner_->bytes(); }
  Result<Advance> advance(std::uint64_t) override {
    while (!interrupted()) std::this_thread::yield();
    return ended(0, 1, {});
  }

 private:
  Status take_state(const ConstStateView& view, std::uint64_t step) override {
    return inner_->load(view, step);
  }
  Result<std::uint64_t> give_state(const StateView& view) override { return inner_->read_into(view); }
  Status take_inputs(const Inputs& inputs) override { return inner_->set_inputs(inputs); }
  Status take_constants(SharedModel model, std::uint64_t) override {
    return inner_->set_constants(std::move(model));
  }
  std::unique_ptr<Solver> inner_;
};

/// Its row, which is in no table.
inline const BackendRow& endless_backend() {
  static constexpr Precision single[] = {Precision::single};
  static const BackendRow row = [] {
    BackendRow made;
    made.name = made.title = "endless";
    made.precisions = single;
    made.make = [](SharedModel model, const BackendChoice&, const SolverHost&) -> Result<Backend> {
      ASPIC_TRY(auto reference, make_reference_solver(std::move(model), Precision::single));
      Backend backend;
      backend.solver = std::make_unique<Endless>(std::move(reference));
      return backend;
    };
    return made;
  }();
  return row;
}

}  // namespace aspic::test
