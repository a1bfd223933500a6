#pragma once
// Changes what a run simulates, and with what solvers.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "playback/engines.h"
#include "playback/figures.h"
#include "playback/jobs.h"
#include "playback/playback.h"
#include "playback/present.h"
#include "playback/stepper.h"
#include "playback/timeline.h"

namespace aspic {

class Rebuild {
 public:
  /// The references must outlive it.
  Rebuild(Present& present, Timeline& timeline, Jobs& jobs, Figures& figures, Stepper& stepper,
          Playback& playback, EngineFactory& factory)
      : present_(present),
        timeline_(timeline),
        jobs_(jobs),
        figures_(figures),
        stepper_(stepper),
        playback_(playback),
        factory_(factory) {}

  // ---- the setup ----
  /// Runs a changed scene from now on. With `keep_state` the motion continues with other constants, where the
  /// bodies have the same particles. Errors leave everything as it was: scene_rejected, no_device.
  Status change(const Scene& scene, bool keep_state);
  /// The same without waiting: where building takes long a thread builds the model, and solvers that need no
  /// context, while nothing moves; a later Simulation::update() continues with it. take_change() returns how
  /// a change ended, once for each; a request before that replaces one that has not begun, and
  /// Playback::seek() drops it.
  void request(const Scene& scene, bool keep_state);
  std::optional<Status> take_change() { return std::exchange(change_result_, std::nullopt); }
  bool changing() const { return requested() || building(); }
  /// Another setup, as change() does; hands that are no part of it are undone.
  Status adopt(Setup setup, bool keep_state);
  /// Back to the scene's start, which also forgets a divergence and all that hands did. Paused or running
  /// stays.
  Status reset();
  /// The run begins with this state of the model, whatever step it is at, and has these inputs until reset(),
  /// after which it begins at the scene's start again.
  Status start_from(const State& state, InputLog inputs = {});

  // ---- hands: errors as of change() ----
  /// Pins a free particle where it is, or frees a pinned one.
  Status toggle_pin(std::uint32_t particle);
  /// Adds balls that fly from the next step on.
  Status throw_balls(const std::vector<BallSettings>& balls);
  /// Removes all balls that were thrown by hand.
  Status clear_balls();

  // ---- the solvers ----
  /// Carries the state over to another backend, to the bit. On an error nothing changes.
  Status set_backend(const BackendRow& backend);
  /// Shadow mode: a backend that is not the leader does the same steps, and the states are compared. Null
  /// ends it.
  Status set_shadow(const BackendRow* backend);
  /// Before the context goes: a run that needs it continues on contextless_backend(), from the last copy;
  /// Simulation::take_message() tells `why`.
  Status leave_context(const Error& why);
  /// The context of solvers to come, after leave_context().
  void set_context(gl::Context& context) { factory_.set_context(context); }

  // ---- for Simulation::update() ----
  /// A change waits to begin.
  bool requested() const { return request_ && request_->seeks == playback_.seeks(); }
  /// Its model is being built.
  bool building() const { return building_; }
  /// Begins the change that was asked for; no job is under way.
  void begin();

 private:
  struct Request {
    ModelSettings settings;
    bool keep_state = false;
    std::uint64_t seeks = 0;  // Playback::seeks() at that time
  };
  /// Another setup on its way, and the state that continues in it.
  struct Change {
    Setup setup;
    bool keep_state = false;
    State state;
    std::size_t scene_balls = 0;
  };
  /// The model of a change.
  struct Built {
    SharedModel model;
    bool constants = false;  ///< it differs from the present one in constants alone
    /// Its solvers; nothing where the present ones go over to it, or are made on the run's thread.
    std::optional<Engines> engines;
  };
  Status change_setup(Setup setup, bool keep_state);
  Change begin_change(Setup setup, bool keep_state) const;
  Result<Built> build(const Change& change, bool with_engines);
  Status finish_change(Change change, Result<Built> built);
  Status change_constants(const Change& change, SharedModel model);
  Status begin_stretch(const State& state);
  void forget_run();

  Present& present_;
  Timeline& timeline_;
  Jobs& jobs_;
  Figures& figures_;
  Stepper& stepper_;
  Playback& playback_;
  EngineFactory& factory_;
  std::optional<Request> request_;
  std::optional<Status> change_result_;
  bool building_ = false;
};

}  // namespace aspic
