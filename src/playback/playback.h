#pragma once
// Moves a run through its history: any step since the start, as long as memory for its keyframes lasts.
#include "base/result.h"
#include "playback/engines.h"
#include "playback/history.h"
#include "playback/jobs.h"
#include "playback/present.h"
#include "playback/stepper.h"
#include "playback/timeline.h"

namespace aspic {

class Playback {
 public:
  /// The references must outlive it.
  Playback(Present& present, Timeline& timeline, Jobs& jobs, Figures& figures, Stepper& stepper,
           EngineFactory& factory)
      : present_(present),
        timeline_(timeline),
        jobs_(jobs),
        figures_(figures),
        stepper_(stepper),
        factory_(factory) {}

  const History& history() const { return timeline_.history(); }
  Moment here() const { return timeline_.here(); }
  bool at_end() const { return timeline_.at_end(); }
  /// The history ended with a divergence, wherever in it the run is.
  bool ends_diverged() const { return timeline_.ends_diverged(); }
  /// Where to start again after a divergence: well before the present state.
  Moment before_trouble() const { return history().keyframes_before(here(), 5); }

  /// Goes to a moment of the history and pauses there; Simulation::update() makes the way. The next step that
  /// is simulated from there on makes the history end there. A history that ended with a divergence has it at
  /// its end.
  Status seek(const Moment& moment);
  bool seeking() const { return timeline_.seeking(); }
  /// Calls of seek() so far.
  std::uint64_t seeks() const { return seeks_; }
  /// One step back; does nothing at the beginning.
  Status step_back();
  bool can_step_back() const { return earlier().has_value(); }
  /// Takes over the history of another run, which is not empty, and goes to its beginning. Errors: those of
  /// Rebuild::change().
  Status replay(History history);

  /// Goes on with the way, for about `budget` seconds.
  Status go_on(double budget);
  /// The next of the single steps that were asked for: in the past it follows the history.
  Status step_singly();
  /// Ends the work in progress, so that the snapshot is the state to the step; waits for the end of a way
  /// only to `arrive`.
  Status halt(bool arrive);
  /// Waits for all that was asked for, single steps included.
  Status settle();

 private:
  std::optional<Moment> earlier() const;

  Present& present_;
  Timeline& timeline_;
  Jobs& jobs_;
  Figures& figures_;
  Stepper& stepper_;
  EngineFactory& factory_;
  std::uint64_t seeks_ = 0;
};

}  // namespace aspic
