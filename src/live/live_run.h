#pragma once
// A run of the reference that obeys a page: made of a scene's text, advanced from image to image, changed
// on its way. Browsers have it as WebAssembly (exports.cpp), the tests as it is.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/inputs.h"
#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"

namespace aspic::live {

class LiveRun {
 public:
  /// A run at the start of the scene of this TOML text, in single precision. Errors (scene_rejected):
  /// parse_scene(), build_model(), make_reference_solver().
  static Result<LiveRun> create(std::string_view text);

  /// Goes on from the state it has with other values of some keys, a KEY=VALUE on each line
  /// (with_overrides()), and with these channels of the inputs, in the order of the scene that it began with;
  /// then a divergence is forgotten. Errors, after which nothing has changed: those of create(); a scene of
  /// other particles or balls (scene_rejected); more channels than there are (usage).
  Status change(std::string_view lines, std::vector<double> channels = {});

  /// Solver::advance().
  Result<Advance> advance(std::uint64_t steps) { return solver_->advance(steps); }

  /// Copies the state into numbers(), and measures it. Errors: none but a solver's.
  Status take();
  /// After take(): the state's step, its hash (state_hash_text()) and its measures.
  std::uint64_t step() const { return step_; }
  const std::string& hash() const { return hash_; }
  const Measures& measures() const { return measures_; }
  /// r/r₀ − 1 by Actuation::classes, at that step.
  const std::vector<float>& changes() const { return changes_; }
  /// The work of actuators since the first take() or load(), as ActuatorWork adds it up; a change() of their
  /// constants does work too. Nothing without actuators.
  std::optional<double> work() const { return work_; }

  /// Room for a state: the fields of state_fields one after the other, three numbers a vector.
  std::span<float> numbers() { return numbers_; }
  /// Takes over the state in numbers(), of that step.
  Status load(std::uint64_t step);

  const Model& model() const { return solver_->model(); }

 private:
  LiveRun(Scene scene, std::unique_ptr<Solver> solver);
  StateView places();
  Result<Inputs> inputs_for(const Model& model, std::span<const double> channels) const;

  Scene scene_;
  std::unique_ptr<Solver> solver_;
  std::vector<std::string> names_;  // of the channels of the scene that it began with
  Inputs inputs_;
  std::vector<float> numbers_;
  std::uint64_t step_ = 0;
  std::string hash_;
  Measures measures_;
  std::vector<float> changes_;
  std::unique_ptr<Meter> meter_;  // of the solver's model
  ActuatorWork actuators_;
  std::optional<double> work_;
};

}  // namespace aspic::live
