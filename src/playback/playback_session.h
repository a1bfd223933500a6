#pragma once
// A run in motion: what it is made of, and how its parts act together.
#include <memory>
#include <optional>
#include <string>

#include "aspic/solver.h"
#include "base/result.h"
#include "gpu/context.h"
#include "playback/engines.h"
#include "playback/figures.h"
#include "playback/jobs.h"
#include "playback/playback.h"
#include "playback/present.h"
#include "playback/rebuild.h"
#include "playback/stepper.h"
#include "playback/timeline.h"
#include "run/backends.h"

namespace aspic {

/// All calls from one thread, with the context current. Only settle() waits for a long step; other calls
/// cancel it and repeat it later.
class PlaybackSession {
 public:
  /// `context` must outlive it. Errors: those of the scene and of make_backend().
  static Result<std::unique_ptr<PlaybackSession>> create(gl::Context& context, const Scene& scene,
                                                         const BackendRow& backend,
                                                         const BackendChoice& asked = {});

  // ---- its parts ----
  const Present& present() const { return present_; }
  const Playback& playback() const { return playback_; }
  Playback& playback() { return playback_; }
  const Rebuild& rebuild() const { return rebuild_; }
  Rebuild& rebuild() { return rebuild_; }
  Stepper& stepper() { return stepper_; }
  const Samples& samples() const { return figures_.samples(); }
  const Jobs& jobs() const { return jobs_; }
  const Pacer& pacer() const { return stepper_.pacer(); }
  Pacer& pacer() { return stepper_.pacer(); }

  // ---- of the present ----
  const Model& model() const { return present_.model(); }
  std::uint64_t step() const { return present_.step(); }
  double time() const { return present_.time(); }
  const std::optional<Divergence>& divergence() const { return present_.divergence(); }
  const State& snapshot() const { return present_.snapshot(); }
  /// Reads the state back; of a backend outside the context the newest that is finished.
  Status refresh_snapshot() { return stepper_.refresh_snapshot(); }
  /// What happened unasked since the last call, in a sentence: a backend failed and contextless_backend()
  /// continues.
  std::optional<Error> take_message() { return present_.take_message(); }

  // ---- motion ----
  void set_running(bool running) { stepper_.set_running(running); }
  bool running() const { return stepper_.running(); }
  /// One step while paused, of a large model in the thread while update() is called; does nothing while
  /// running or diverged. In the past it follows the history.
  Status single_step();
  /// From the next step on; nothing lets go.
  void set_hand(const std::optional<Pull>& hand) { stepper_.acts().hand = hand; }
  /// What holds in the step that begins here.
  Inputs inputs() const { return stepper_.inputs(); }
  const std::optional<Pull>& hand() const { return stepper_.acts().hand; }
  /// Once for each image: takes what the solver finished and sets it to work again for at most about
  /// `budget` seconds. `dt` is the time since the last call [s]. A backend that fails in the context is
  /// replaced by contextless_backend(), see take_message().
  Status update(double dt, double budget);
  /// Ends the work in progress, so that snapshot() is the state to the step; waits for a way through history
  /// only to `arrive`.
  Status halt(bool arrive = false) { return playback_.halt(arrive); }
  /// Waits for all that was asked for, single steps included.
  Status settle() { return playback_.settle(); }
  /// Steps or a change are under way, or done and not taken up by update() yet.
  bool busy() const { return !jobs_.idle() || stepper_.single_steps() > 0; }

 private:
  PlaybackSession(gl::Context& context, Setup setup, const BackendChoice& asked);
  Status move(double dt, double budget);

  EngineFactory factory_;
  Present present_;
  Timeline timeline_;
  Figures figures_;
  Stepper stepper_;
  Playback playback_;
  Rebuild rebuild_;
  Jobs jobs_;  // last: they use all of the above
};

/// Simulated seconds per second; 0 while paused.
double real_time_factor(const PlaybackSession& simulation);
/// Spring evaluations per second; nothing with implicit-euler, which has no fixed number a step.
std::optional<double> spring_evaluations_per_second(const PlaybackSession& simulation);

}  // namespace aspic
