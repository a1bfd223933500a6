#pragma once
// What a run simulates now, with what solvers, and the state that it has come to.
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "aspic/solver.h"
#include "aspic/state.h"
#include "base/result.h"
#include "device/device_state.h"
#include "playback/engines.h"
#include "playback/setup.h"

namespace aspic {

class Present {
 public:
  explicit Present(Setup setup) : setup_(std::move(setup)) {}

  const Setup& setup() const { return setup_; }
  const Model& model() const { return engines_.model(); }
  const Engines& engines() const { return engines_; }
  Engines& engines() { return engines_; }
  /// Of the leader.
  const BackendRow& backend() const { return *engines_.leader().row; }
  const Solver& solver() const { return *engines_.leader().solver; }
  /// The gpu's own state to draw; nothing where the state is the snapshot.
  std::optional<DeviceState> device_state() const;

  std::uint64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * model().simulation.timestep; }
  const std::optional<Divergence>& divergence() const { return divergence_; }
  /// The last state that reached this side: of a backend in the context as of the last
  /// Simulation::refresh_snapshot(), ten times a second while running; of any other that of the image.
  const State& snapshot() const { return snapshot_; }
  /// How long it has been here [s].
  double snapshot_age() const;

  /// Changes whenever model() became another.
  std::uint64_t model_number() const { return model_number_; }
  /// Changes whenever the run restarts.
  std::uint64_t run_number() const { return run_number_; }
  /// Changes whenever what there is to draw did.
  std::uint64_t image_number() const { return image_number_; }

  /// Another setup with its solvers; on an error nothing changes.
  Status install(Setup setup, Result<Engines> engines);
  /// The solvers go over to a setup whose model differs from theirs in constants alone. Errors: those of
  /// Solver::set_constants().
  Status set_constants(Setup setup, SharedModel model);
  /// The state has another meaning, and is to be drawn again.
  void redraw() { ++image_number_; }
  /// All solvers are at this state, which has not diverged.
  Status load(const State& state);
  void take_snapshot(State state);
  /// The leader did so many steps.
  void advance(std::uint64_t steps);
  /// The leader is at this step.
  void set_step(std::uint64_t step) { step_ = step; }
  void set_divergence(const std::optional<Divergence>& divergence) { divergence_ = divergence; }
  void begin_run() { ++run_number_; }
  /// For take_message(): what happened unasked.
  void tell(Error message) { message_ = std::move(message); }
  std::optional<Error> take_message() { return std::exchange(message_, std::nullopt); }

 private:
  Setup setup_;
  Engines engines_;
  State snapshot_;
  std::chrono::steady_clock::time_point snapshot_time_ = {};
  std::uint64_t step_ = 0, model_number_ = 0, run_number_ = 0, image_number_ = 0;
  std::optional<Divergence> divergence_;
  std::optional<Error> message_;
};

}  // namespace aspic
