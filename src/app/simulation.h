#pragma once
// A run in motion: its solvers, what paces it, what hands do to it, and its past.
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/energy.h"
#include "app/history.h"
#include "app/setup.h"
#include "app/worker.h"
#include "base/result.h"
#include "device/device_state.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "model/solver.h"
#include "run/backends.h"
#include "scene/scene.h"

namespace aspic::app {

/// How fast simulated time passes.
enum class Pace {
  steps_per_frame,  ///< the scene's steps for each picture, whatever time that takes
  real_time         ///< as much simulated time as passes outside
};

/// Energies at one time, a point of the plot.
struct EnergySample {
  double time = 0.0;  ///< [s]
  Measures measures;
  std::uint64_t step = 0;
};

/// How far the two backends of shadow mode were apart at one time.
struct DifferenceSample {
  double time = 0.0;       ///< [s]
  double metres = 0.0;     ///< largest |difference| of a position's component; infinite if one alone diverged
  std::uint64_t ulp = 0;   ///< largest distance of any component of the state
  bool identical = false;  ///< every bit is the same
};

/// All calls from the window's thread, with its context current. A backend that needs the context advances in
/// batches that keep within a frame, every other in a thread of its own.
class Simulation {
 public:
  /// `context` must outlive it. Errors: those of the scene and of make_backend().
  static Result<std::unique_ptr<Simulation>> create(gl::Context& context, const Scene& scene,
                                                    const BackendRow& backend);
  ~Simulation();

  // ---- what is simulated, and by whom ----
  /// Takes on a changed scene. With `keep_state` the motion goes on with other constants, where the bodies
  /// have the same particles. Errors leave everything as it was: scene_rejected, no_device.
  Status change(const Scene& scene, bool keep_state);
  /// The same without waiting: where building takes long a thread does it while nothing moves, and update()
  /// takes it on once it is done. take_change() tells how a change ended, once for each; a request before
  /// that replaces one that has not begun.
  void request_change(const Scene& scene, bool keep_state);
  std::optional<Status> take_change() { return std::exchange(change_result_, std::nullopt); }
  bool changing() const { return wanted_change_.has_value() || change_.has_value(); }
  /// Carries the state over to another backend, to the bit. On an error nothing changes.
  Status set_backend(const BackendRow& backend);
  /// Back to the scene's start, which also forgets a divergence and all that hands did. Paused or running
  /// stays.
  Status reset();
  const Setup& setup() const { return setup_; }
  /// Before the context goes: whatever is on the gpu goes on on the reference, from the last copy;
  /// take_message() tells `why`.
  Status leave_gpu(const Error& why);
  /// The context of solvers to come, after leave_gpu().
  void set_context(gl::Context& context);
  const BackendRow& backend() const { return *engine_.row; }
  const Solver& solver() const { return *engine_.solver; }
  GpuSolver* gpu() { return engine_.gpu; }
  const Model& model() const { return *model_; }
  /// Changes whenever model() became another.
  std::uint64_t model_number() const { return model_number_; }

  // ---- time ----
  void set_running(bool running);
  bool running() const { return running_; }
  /// One step while paused; does nothing while running or diverged. In the past it follows the history.
  Status single_step();
  /// Once for each picture: hands over what the solver finished and sets it to work again for at most about
  /// `budget` seconds. `dt` is the time since the last call [s]. A gpu that fails is replaced by the
  /// reference, see take_message().
  Status update(double dt, double budget);
  /// Waits for the work under way, a way through history included, so that snapshot() is the state to the
  /// step.
  Status settle();
  /// A step that update() does not pass, however far the pace has come: a film wants its picture first.
  void pause_at(std::optional<std::uint64_t> step) { pause_step_ = step; }
  bool at_pause_step() const { return pause_step_ && step_ >= *pause_step_; }
  std::uint64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * model_->simulation.timestep; }
  const std::optional<Divergence>& divergence() const { return divergence_; }

  Pace pace = Pace::steps_per_frame;
  double speed = 1.0;  ///< factor on the pace, > 0

  // ---- history: any step since the start, as long as memory for its keyframes lasts ----
  const History& history() const { return history_; }
  Moment here() const { return {stretch_, step_}; }
  bool at_end() const { return here() == history_.end_moment(); }
  /// Goes to a moment of the history and pauses there; update() takes it on its way. The next step that is
  /// simulated from there on makes the history end there.
  Status seek(const Moment& moment);
  bool seeking() const { return seek_.has_value(); }
  /// One step back; does nothing at the beginning.
  Status step_back();
  /// Where to start anew after a divergence: well before the state at hand.
  Moment before_trouble() const { return history_.keyframes_before(here(), 5); }
  bool can_step_back() const { return history_.before(here()).has_value(); }

  // ---- hands ----
  /// From the next step on; nothing lets go.
  void set_hand(const std::optional<Pull>& pull) { hand_ = pull; }
  const std::optional<Pull>& hand() const { return hand_; }
  /// Pins a free particle where it is, or frees a pinned one. Errors: those of change().
  Status toggle_pin(std::uint32_t particle);
  /// Adds balls that fly from the next step on. Errors: those of change().
  Status throw_balls(const std::vector<BallSettings>& balls);
  /// Takes all balls away that were thrown by hand.
  Status clear_balls();

  // ---- shadow mode: another backend does the same steps, and the states are compared ----
  /// The other one is the reference; if that leads, the next in the table.
  Status set_shadow(bool on);
  bool shadowed() const { return shadow_.solver != nullptr; }
  const Solver* shadow() const { return shadow_.solver.get(); }
  const std::deque<DifferenceSample>& differences() const { return differences_; }
  /// Since shadow mode began, or the last change of setup.
  bool ever_differed() const { return ever_differed_; }

  // ---- what to show ----
  /// The gpu's own state to draw; nothing where the state is the snapshot.
  std::optional<DeviceState> device_state() const {
    if (!engine_.gpu) return std::nullopt;
    return engine_.gpu->device_state();
  }
  /// Changes whenever what there is to draw did.
  std::uint64_t picture_number() const { return picture_number_; }
  /// The last state that reached this side: of the reference, that of the picture; of the gpu as of the last
  /// refresh_snapshot(), ten times a second while running.
  const State& snapshot() const { return snapshot_; }
  /// Reads the gpu's state back; of the reference the newest that is finished.
  Status refresh_snapshot();
  double steps_per_second() const { return steps_per_second_; }
  double real_time_factor() const { return running_ ? steps_per_second_ * model_->simulation.timestep : 0.0; }
  /// Spring evaluations per second; nothing with implicit-euler, which has no fixed number a step.
  std::optional<double> spring_evaluations_per_second() const;
  /// The solver does fewer steps than the pace asks for.
  bool behind() const { return running_ && behind_; }
  const std::deque<EnergySample>& energies() const { return energies_; }
  /// What happened unasked since the last call, in a sentence: the gpu failed and the reference goes on.
  std::optional<std::string> take_message() { return std::exchange(message_, std::nullopt); }

 private:
  using Clock = std::chrono::steady_clock;
  /// A model with its solvers, ready to take the place of those in use.
  struct Built {
    std::unique_ptr<Model> model;
    Backend engine, shadow;
    std::optional<std::string> message;
  };
  /// A change on its way: the setup to be built, and the state that will go on in it.
  struct Change {
    Setup setup;
    bool keep_state = false;
    State state;
    std::size_t scene_balls = 0;
  };
  /// What a worker's job leaves.
  struct Outcome {
    std::optional<Error> error;
    std::optional<Divergence> divergence;
    std::uint64_t steps = 0;
    State state;
    std::optional<Divergence> other_divergence;  ///< of the shadow, where the job advances both
    State other_state;
    Measures measures;
    std::unique_ptr<Result<Built>> built;
  };
  explicit Simulation(gl::Context& context);

  Result<Backend> make_engine(const Model& model, const BackendRow& backend);
  Result<Built> build(const Setup& setup);
  void install(Setup setup, Built built);
  Status rebuild(Setup setup);
  Change begin_change(Setup setup, bool keep_state) const;
  Status finish_change(Change change, Result<Built> built);
  void start_change();
  Status load(const State& state);
  Status change_setup(Setup setup, bool keep_state);
  Status fall_back(const Error& error);

  Status prepare_to_advance();
  Status give_pull(const std::optional<Pull>& pull);
  Status advance_run(double dt, double budget);
  Status advance_gpu(std::uint64_t steps, double budget);
  void start_job(std::uint64_t steps, double budget);
  void start_measuring();
  Status take_outcome();
  Status follow(Outcome outcome);
  Status seek_on(double budget);
  Status finish_seek();
  void note(std::uint64_t steps, const std::optional<Divergence>& divergence);
  void add_sample(const State& state, const Measures& measures);
  void remember(const State& state);
  void compare_shadow(const State& other);
  void forget_past();
  void forget_future();

  gl::Context* context_;
  Setup setup_;
  std::unique_ptr<Model> model_;
  Backend engine_, shadow_;
  std::optional<gl::Arithmetic> arithmetic_;  // what the canary found once; the device does not change
  std::uint64_t model_number_ = 0, picture_number_ = 0, step_ = 0;
  State snapshot_;
  Clock::time_point snapshot_time_ = {};
  bool running_ = false, behind_ = false, has_outcome_ = false;
  std::optional<std::uint64_t> pause_step_;
  double due_ = 0.0;  // steps the pace has asked for and nobody has done
  std::uint64_t batch_ = 1;
  std::optional<Divergence> divergence_;
  std::optional<std::string> message_;

  History history_;
  std::uint64_t stretch_ = 0;
  std::optional<std::uint64_t> seek_;  // step of stretch_ on the way to
  std::optional<Pull> hand_;
  std::optional<std::optional<Pull>> given_;  // to the solvers; absent: not known of all of them
  Clock::time_point last_remembered_ = {}, last_sampled_ = {}, rate_start_ = {};
  std::uint64_t rate_steps_ = 0;
  double steps_per_second_ = 0.0;
  std::deque<EnergySample> energies_;
  std::deque<DifferenceSample> differences_;
  bool ever_differed_ = false;
  std::optional<std::pair<ModelSettings, bool>> wanted_change_;  // not begun; true: keeps the state
  std::optional<Change> change_;                                 // the worker builds for it
  std::optional<Status> change_result_;
  Outcome outcome_;
  Worker worker_;  // last: its job uses all of the above
};

}  // namespace aspic::app
