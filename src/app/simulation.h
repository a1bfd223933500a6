#pragma once
// A scene in motion: the solver, what paces it, and what is known of it from frame to frame.
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/energy.h"
#include "app/worker.h"
#include "base/result.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "model/solver.h"
#include "render/device_state.h"
#include "scene/scene.h"

namespace aspic::app {

enum class BackendName { reference, gpu };

/// How fast simulated time passes.
enum class Pace {
  steps_per_frame,  ///< the scene's steps for each picture, whatever time that takes
  real_time         ///< as much simulated time as passes outside
};

/// Energies at one time, a point of the plot.
struct EnergySample {
  double time = 0.0;  ///< [s]
  Measures measures;
};

/// All calls from the window's thread, with its context current. The reference advances in a thread of its
/// own; the gpu in batches that keep within a frame.
class Simulation {
 public:
  /// `context` must outlive it. The gpu is taken if `backend` says so; see make_solver for errors.
  static Result<std::unique_ptr<Simulation>> create(gl::Context& context, const Scene& scene,
                                                    BackendName backend);
  ~Simulation();

  /// Takes on a changed scene. With `keep_state` the motion goes on with other constants; the bodies must
  /// have the same particles then. Errors leave everything as it was: scene_rejected, no_device.
  Status change(const Scene& scene, bool keep_state);
  /// Carries the state over to another backend, to the bit. On an error nothing changes.
  Status set_backend(BackendName backend);
  /// Back to the scene's start, which also forgets a divergence. Paused or running stays.
  Status reset();

  void set_running(bool running);
  bool running() const { return running_; }
  /// One step while paused; does nothing while running or diverged.
  Status single_step();

  /// Once for each picture: hands over what the solver finished and sets it to work again for at most about
  /// `budget` seconds. `dt` is the time since the last call [s]. Error (no_device): the device was lost.
  Status update(double dt, double budget);
  /// Waits for the work under way, so that snapshot() is the state to the step.
  Status settle();

  /// A step that update() does not pass, however far the pace has come: a film wants its picture first.
  void pause_at(std::optional<std::uint64_t> step) { pause_step_ = step; }
  bool at_pause_step() const { return pause_step_ && step_ >= *pause_step_; }

  BackendName backend() const { return gpu_ ? BackendName::gpu : BackendName::reference; }
  const Solver& solver() const { return *solver_; }
  const Model& model() const { return *model_; }
  /// Changes whenever model() became another.
  std::uint64_t model_number() const { return model_number_; }
  /// The gpu's own state to draw; nothing where the state is the snapshot.
  std::optional<DeviceState> device_state() const {
    if (!gpu_) return std::nullopt;
    return DeviceState{&gpu_->particles(), &gpu_->balls(), gpu_->first_ball(), step_};
  }
  /// Changes whenever what there is to draw did.
  std::uint64_t picture_number() const { return picture_number_; }

  /// The last state that reached this side: of the reference, that of the picture; of the gpu as of the last
  /// refresh_snapshot(), ten times a second while running.
  const State& snapshot() const { return snapshot_; }
  /// Reads the gpu's state back; of the reference the newest that is finished.
  Status refresh_snapshot();

  std::uint64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * model_->simulation.timestep; }
  const std::optional<Divergence>& divergence() const { return divergence_; }

  /// Takes the run back to a state remembered from before, newest first: one about every half second.
  bool can_step_back() const { return !past_.empty(); }
  /// Time of that state [s]; legal while can_step_back().
  double step_back_time() const;
  Status step_back();

  Pace pace = Pace::steps_per_frame;
  double speed = 1.0;  ///< factor on the pace, > 0

  double steps_per_second() const { return steps_per_second_; }
  double real_time_factor() const { return running_ ? steps_per_second_ * model_->simulation.timestep : 0.0; }
  /// Spring evaluations per second; nothing with implicit-euler, which has no fixed number a step.
  std::optional<double> spring_evaluations_per_second() const;
  /// The solver does fewer steps than the pace asks for.
  bool behind() const { return running_ && behind_; }
  const std::deque<EnergySample>& energies() const { return energies_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// What a worker's job leaves.
  struct Outcome {
    std::optional<Error> error;
    std::optional<Divergence> divergence;
    std::uint64_t steps = 0;
    State state;
    Measures measures;
  };
  Simulation(gl::Context& context) : context_(context) {}
  struct Made {
    std::unique_ptr<Solver> solver;
    GpuSolver* gpu = nullptr;
  };
  Result<Made> make_solver(const Model& model, BackendName backend);
  void install(Made made);
  Status load(const State& state);
  Status take_outcome();
  Status advance_gpu(std::uint64_t steps, double budget);
  void start_job(std::uint64_t steps, double budget);
  void start_measuring();
  void note(std::uint64_t steps, const std::optional<Divergence>& divergence);
  void add_sample(const State& state, const Measures& measures);
  void remember(const State& state);
  void forget_history();

  gl::Context& context_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Solver> solver_;
  GpuSolver* gpu_ = nullptr;  // solver_, where it is one
  std::uint64_t model_number_ = 0, picture_number_ = 0, step_ = 0;
  State snapshot_;
  bool running_ = false, behind_ = false, has_outcome_ = false;
  std::optional<std::uint64_t> pause_step_;
  double due_ = 0.0;  // steps the pace has asked for and nobody has done
  std::uint64_t batch_ = 1;
  double batch_time_ = 0.0;
  std::optional<Divergence> divergence_;
  std::deque<State> past_;
  Clock::time_point last_remembered_ = {}, last_sampled_ = {}, rate_start_ = {};
  std::uint64_t rate_steps_ = 0;
  double steps_per_second_ = 0.0;
  std::deque<EnergySample> energies_;
  Outcome outcome_;
  Worker worker_;  // last: its job uses all of the above
};

}  // namespace aspic::app
