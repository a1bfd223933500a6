#pragma once
// Runs compared: the scene's own and others of the same scene, each with one difference, on one clock; and
// the ghost, an earlier run on the same clock.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "playback/comparison_clock.h"
#include "playback/ghost_run.h"
#include "playback/playback_session.h"
#include "playback/variant_run.h"

namespace aspic {

/// The states that are shown change together, once each run has come to the clock's time; the leader, the
/// scene's own run, waits for the others.
class Comparison {
 public:
  /// The references must outlive it. `scene` is the leader's.
  Comparison(PlaybackSession& leader, const Scene& scene, const BackendChoice& asked)
      : scene_(scene), asked_(asked), runs_{leader}, clock_(runs_) {}

  // ---- the runs ----
  /// Other runs are compared with the leader.
  bool active() const { return !runs_.variants.empty(); }
  /// More than the leader is shown.
  bool several() const { return runs_.several; }
  /// Runs in all, the leader included, which is number 0.
  std::size_t count() const { return runs_.count(); }
  const PlaybackSession& run(std::size_t i) const { return runs_.run(i); }
  PlaybackSession& run(std::size_t i) { return i == 0 ? runs_.leader : runs_.variants[i - 1]->simulation(); }
  const Scene& scene(std::size_t i) const { return i == 0 ? scene_ : runs_.variants[i - 1]->scene(); }
  std::vector<Difference> differences() const;
  /// A difference that cannot be had.
  struct Refusal {
    Difference difference;
    Error why;
  };
  /// Has these differences instead. New runs are made in `context`, which must outlive them; they begin at
  /// the start, and so all do. Where one is refused all stays as it was.
  std::optional<Refusal> set(gl::Context& context, const std::vector<Difference>& differences);
  /// Ends all runs but the leader.
  void end();
  /// A run other than the leader has something to take up.
  bool busy() const;
  /// Why hands that touch particles cannot act on all runs; nothing: they can.
  std::optional<std::string> hands_refused() const;

  // ---- the ghost ----
  const GhostRun* ghost() const { return ghost_.get(); }
  GhostRun* ghost() { return ghost_.get(); }
  /// The leader's run so far is the ghost from now on, instead of another one. Errors: those of
  /// GhostRun::create(), after which there is none.
  Status keep_ghost(gl::Context& context);
  void remove_ghost();

  // ---- the clock ----
  ComparisonClock& clock() { return clock_; }
  const ComparisonClock& clock() const { return clock_; }
  /// Before the leader moves: it waits for the others.
  void lead();
  /// After it moved: the others follow. `dt` and `budget` as of Simulation::update(). Errors: of Simulation.
  Status follow(double dt, double budget);
  /// All runs have come to one time, which is shown.
  bool settled() const { return runs_.settled; }
  /// Changes whenever the states that are shown together did: those of all snapshots, right after follow().
  std::uint64_t shown_number() const { return shown_number_; }
  /// The time that is shown of a run [s], and its divergence if it diverged on the way there.
  double shown_time(std::size_t i) const { return runs_.shown_time(i); }
  std::optional<Divergence> shown_divergence(std::size_t i) const {
    return i < runs_.shown.size() ? runs_.shown[i].divergence : std::nullopt;
  }
  /// What happened unasked since the last call.
  std::vector<Error> take_messages() { return std::exchange(messages_, {}); }

 private:
  Status recall(double time, double dt, double budget);
  Status follow_with_ghost(double time, double dt, double budget);
  void show();
  void runs_changed();

  const Scene& scene_;
  BackendChoice asked_;
  ComparedRuns runs_;
  ComparisonClock clock_;
  std::unique_ptr<GhostRun> ghost_;
  std::uint64_t ghost_shown_ = 0;  // image number of the ghost that is shown
  std::uint64_t shown_number_ = 0;
  std::vector<Error> messages_;
};

}  // namespace aspic
