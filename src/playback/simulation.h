#pragma once
// A run in motion: moves its solvers forward and through its past, and changes what is simulated.
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aspic/solver.h"
#include "base/result.h"
#include "device/device_state.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "playback/engines.h"
#include "playback/history.h"
#include "playback/pacer.h"
#include "playback/samples.h"
#include "playback/setup.h"
#include "playback/worker.h"
#include "run/backends.h"

namespace aspic {

/// All calls from the window's thread, with its context current. A backend that needs the context advances in
/// batches that keep within a frame; every other in a separate thread, while the state it finished last is
/// drawn. Only settle() waits for a long step; other calls cancel it and repeat it later.
class Simulation {
 public:
  /// `context` must outlive it. Errors: those of the scene and of make_backend().
  static Result<std::unique_ptr<Simulation>> create(gl::Context& context, const Scene& scene,
                                                    const BackendRow& backend,
                                                    const BackendChoice& asked = {});

  // ---- what is simulated, and by whom ----
  /// Runs a changed scene from now on. With `keep_state` the motion continues with other constants, where the
  /// bodies have the same particles. Errors leave everything as it was: scene_rejected, no_device.
  Status change(const Scene& scene, bool keep_state);
  /// The same without waiting: where building takes long a thread does it while nothing moves, and a later
  /// update() continues with it. take_change() returns how a change ended, once for each; a request before
  /// that replaces one that has not begun.
  void request_change(const Scene& scene, bool keep_state);
  std::optional<Status> take_change() { return std::exchange(change_result_, std::nullopt); }
  bool changing() const { return requested_.has_value() || change_.has_value(); }
  /// A thread is at work on a step or a change for longer than a picture should take.
  bool working() const;
  /// Steps or a change are under way, or done and not taken up by update() yet.
  bool busy() const { return !idle() || single_steps_ > 0; }
  /// update() has something new to take up.
  bool has_news() const { return !outcomes_.empty(); }
  /// Carries the state over to another backend, to the bit. On an error nothing changes.
  Status set_backend(const BackendRow& backend);
  /// Back to the scene's start, which also forgets a divergence and all that hands did. Paused or running
  /// stays.
  Status reset();
  /// The run begins with this state of the model, whatever step it is at; after reset() that is the scene's
  /// start again.
  Status start_from(const State& state);
  const Setup& setup() const { return setup_; }
  /// Changes whenever the run restarts, by reset() or start_from().
  std::uint64_t run_number() const { return run_number_; }
  /// Runs another setup from now on, as change() does; hands that are no part of it are undone.
  Status adopt(Setup setup, bool keep_state) {
    requested_.reset();
    return change_setup(std::move(setup), keep_state);
  }
  /// Before the context goes: a run that needs it continues on the reference, from the last copy;
  /// take_message() tells `why`.
  Status leave_context(const Error& why) { return engines_.use_context() ? fall_back(why) : Status(); }
  /// The context of solvers to come, after leave_context().
  void set_context(gl::Context& context) { factory_.set_context(context); }
  const BackendRow& backend() const { return *engines_.leader().row; }
  const Solver& solver() const { return *engines_.leader().solver; }
  GpuSolver* gpu() { return gpu_of(engines_.leader()); }
  const Model& model() const { return engines_.model(); }
  /// Changes whenever model() became another.
  std::uint64_t model_number() const { return model_number_; }

  // ---- time ----
  Pacer& pacer() { return pacer_; }
  const Pacer& pacer() const { return pacer_; }
  void set_running(bool running);
  bool running() const { return running_; }
  /// One step while paused, of a large model in the thread while update() is called; does nothing while
  /// running or diverged. In the past it follows the history.
  Status single_step();
  /// Once for each picture: takes what the solver finished and sets it to work again for at most about
  /// `budget` seconds. `dt` is the time since the last call [s]. A backend that fails in the context is
  /// replaced by the reference, see take_message().
  Status update(double dt, double budget);
  /// Ends the work in progress, so that snapshot() is the state to the step; waits for a way through history
  /// only to `arrive`.
  Status halt(bool arrive = false);
  /// Waits for all that was asked for, single steps included.
  Status settle();
  std::uint64_t step() const { return step_; }
  double time() const { return static_cast<double>(step_) * model().simulation.timestep; }
  const std::optional<Divergence>& divergence() const { return divergence_; }

  // ---- history: any step since the start, as long as memory for its keyframes lasts ----
  const History& history() const { return history_; }
  Moment here() const { return {stretch_, step_}; }
  bool at_end() const { return here() == history_.end_moment(); }
  /// The history ended with a divergence, wherever in it this is.
  bool ends_diverged() const { return divergence_ || ended_; }
  /// Goes to a moment of the history and pauses there; update() makes the way. The next step that is
  /// simulated from there on makes the history end there. A history that ended with a divergence has it at
  /// its end.
  Status seek(const Moment& moment);
  bool seeking() const { return seek_.has_value(); }
  /// Takes over the history of another run, which is not empty, and goes to its beginning. Errors: those of
  /// change().
  Status replay(History history);
  /// One step back; does nothing at the beginning.
  Status step_back();
  /// Where to start again after a divergence: well before the present state.
  Moment before_trouble() const { return history_.keyframes_before(here(), 5); }
  bool can_step_back() const { return history_.before({stretch_, seek_.value_or(step_)}).has_value(); }

  // ---- hands ----
  /// From the next step on; nothing lets go.
  void set_hand(const std::optional<Pull>& pull) { hand_ = pull; }
  const std::optional<Pull>& hand() const { return hand_; }
  /// Pins a free particle where it is, or frees a pinned one. Errors: those of change().
  Status toggle_pin(std::uint32_t particle);
  /// Adds balls that fly from the next step on. Errors: those of change().
  Status throw_balls(const std::vector<BallSettings>& balls);
  /// Removes all balls that were thrown by hand.
  Status clear_balls();

  // ---- shadow mode: another backend does the same steps, and the states are compared ----
  /// A backend that is not the leader; null ends shadow mode.
  Status set_shadow(const BackendRow* backend);
  bool shadowed() const { return engines_.shadowed(); }
  const Solver* shadow() const { return engines_.shadow().solver.get(); }
  const BackendRow* shadow_backend() const { return engines_.shadow().row; }

  // ---- what to show ----
  /// The gpu's own state to draw; nothing where the state is the snapshot.
  std::optional<DeviceState> device_state() const;
  /// Changes whenever what there is to draw did.
  std::uint64_t picture_number() const { return picture_number_; }
  /// The last state that reached this side: of a backend in the context as of the last refresh_snapshot(),
  /// ten times a second while running; of any other that of the picture.
  const State& snapshot() const { return snapshot_; }
  /// Reads the state back; of a backend in its own thread the newest that is finished.
  Status refresh_snapshot();
  double real_time_factor() const {
    return running_ ? pacer_.steps_per_second() * model().simulation.timestep : 0.0;
  }
  /// Spring evaluations per second; nothing with implicit-euler, which has no fixed number a step.
  std::optional<double> spring_evaluations_per_second() const;
  const Samples& samples() const { return samples_; }
  /// What happened unasked since the last call, in a sentence: a backend failed and the reference continues.
  std::optional<std::string> take_message() { return std::exchange(message_, std::nullopt); }

 private:
  using Clock = std::chrono::steady_clock;
  /// Another setup on its way, the state that continues in it, and once they are made its solvers.
  struct Change {
    Setup setup;
    bool keep_state = false;
    State state;
    std::size_t scene_balls = 0;
    std::optional<Result<Engines>> engines = {};
  };
  Simulation(gl::Context& context, Setup setup, const BackendChoice& asked);

  Status install(Setup setup, Result<Engines> engines);
  Change begin_change(Setup setup, bool keep_state) const;
  Status finish_change(Change change);
  void start_change();
  Status change_setup(Setup setup, bool keep_state);
  Status begin_history(const State& state);
  Status load(const State& state);
  Status fall_back(const Error& error);

  Status prepare_to_advance();
  Status advance_run(double dt, double budget);
  Status advance_here(std::uint64_t steps, double budget);
  bool idle() const { return !worker_.busy() && outcomes_.empty(); }
  bool steps_quickly() const;
  Status step_singly();
  Status show_figures();
  Status start_steps(std::uint64_t to, double budget);
  void start_job(std::uint64_t to, double budget, bool alone, std::optional<Pull> pull);
  void start_measuring();
  Status sample_here();
  Status collect();
  Status take(JobResult outcome);
  Status follow(JobResult outcome);
  /// The window does not wait for a job, so it may take longer than a picture [s].
  static constexpr double shortest_job = 0.030;
  Status seek_on(double budget);
  void arrive();
  void note(std::uint64_t steps, const std::optional<Divergence>& divergence);
  void reach(std::uint64_t step, const std::optional<Divergence>& divergence);
  void take_snapshot(State state);
  void remember(const State& state, const std::vector<EnergySample>& energies);
  void forget_future(double now);

  Setup setup_;
  EngineFactory factory_;
  Engines engines_;
  Pacer pacer_;
  Samples samples_;
  std::uint64_t model_number_ = 0, run_number_ = 0, picture_number_ = 0, step_ = 0;
  State snapshot_;
  Clock::time_point snapshot_time_ = {};
  bool running_ = false;
  std::uint64_t batch_ = 1;  // steps between two looks at the clock, of a backend in the context
  /// Of a backend in the context: energies are those of every next_sample_step() with this stride, a
  /// power of two that keeps the time for reading states back low.
  std::uint64_t sample_stride_ = 1;
  double read_seconds_ = 0.0;  // for the last energies
  std::optional<Divergence> divergence_;
  std::optional<std::pair<Moment, Divergence>> ended_;  // how the history ended, while elsewhere in it
  std::optional<std::string> message_;

  History history_;
  std::uint64_t stretch_ = 0;
  std::optional<std::uint64_t> seek_;  // step of stretch_ on the way to
  std::optional<Pull> hand_;
  Clock::time_point last_remembered_ = {}, last_sampled_ = {};
  std::optional<std::pair<ModelSettings, bool>>
      requested_;                 // a change that has not begun; true: keeps the state
  std::optional<Change> change_;  // the worker builds for it
  std::optional<Status> change_result_;
  std::uint64_t single_steps_ = 0;   // asked for and not done
  Clock::time_point progress_ = {};  // the worker began, or had an outcome
  std::uint64_t job_to_ = 0;         // of the newest job
  std::uint64_t job_step_ = 0;       // where the solvers are; the jobs' own
  Mailbox<Result<JobResult>> outcomes_;
  Worker worker_;  // last: its job uses all of the above
};

}  // namespace aspic
