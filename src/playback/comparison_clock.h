#pragma once
// The clock of runs compared: the time that all of them show, and the run that sets it.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "playback/pacer.h"
#include "playback/playback_session.h"
#include "playback/variant_run.h"

namespace aspic {

/// What is shown of a run.
struct ShownState {
  std::uint64_t image = 0;  ///< Present::image_number()
  double time = 0.0;        ///< [s]
  std::optional<Divergence> divergence;
};

/// The runs compared, with what is shown of them.
struct ComparedRuns {
  PlaybackSession& leader;  ///< the scene's own run, number 0
  std::vector<std::unique_ptr<VariantRun>> variants = {};
  bool several = false;                ///< more than the leader is shown
  bool settled = true;                 ///< all have come to one time, which is shown
  std::vector<ShownState> shown = {};  ///< of each run; empty: nothing is kept

  std::size_t count() const { return variants.size() + 1; }
  const PlaybackSession& run(std::size_t i) const { return i == 0 ? leader : variants[i - 1]->simulation(); }
  double shown_time(std::size_t i) const { return i < shown.size() ? shown[i].time : run(i).time(); }
};

class ComparisonClock {
 public:
  /// `runs` must outlive it.
  explicit ComparisonClock(ComparedRuns& runs) : runs_(runs) {}

  /// The run that sets it: the leader, or after its divergence the first that continues.
  const PlaybackSession& setter() const;
  /// The leader diverged and others continue.
  bool others_go_on() const { return runs_.leader.divergence() && stand_in() != nullptr; }
  /// Starts or pauses those that continue. False if the leader is the one to start.
  bool toggle();
  bool others_run() const { return others_run_; }
  bool runs() const { return runs_.leader.running() || others_run_; }
  /// The time that the images show [s].
  double time() const;
  /// All images show the very step that the setter is at.
  bool is_shown() const;
  /// Pacer::limit() of the setter, and of no other.
  void limit(Hold source, std::optional<std::uint64_t> step);
  /// The last time that there is to go to [s]: of the run that came furthest, while they move what is shown.
  double end_time() const;
  /// To the moment nearest to a time [s]; false if the leader has it: that goes then, and the others follow.
  /// Errors: those of Playback::seek().
  Result<bool> go_to(double time);
  /// Simulated seconds per second of the images; 0 before there is a measurement.
  double real_time_factor() const;
  /// The newest time, up to that of the images, at which all runs but those that diverged have energies
  /// [s].
  double figures_time() const;

  // ---- for Comparison ----
  /// Once for each image, `dt` after the last [s], before the others follow. The variant that goes ahead in
  /// the leader's place; null: none does.
  VariantRun* begin_frame(double dt);
  /// A time after the leader diverged that is shown [s].
  const std::optional<double>& recalled() const { return recalled_; }
  /// The runs are others.
  void restart() { others_run_ = false; }

 private:
  VariantRun* stand_in() const;
  void measure(double dt);

  ComparedRuns& runs_;
  bool others_run_ = false, was_running_ = false;
  std::optional<double> recalled_;
  double factor_ = 0.0, measured_for_ = 0.0, measured_from_ = 0.0;  // real_time_factor() [1], [s], [s]
};

}  // namespace aspic
