#pragma once
// Start, pause, step, backends, and the way back in time; with messages of what became of it.
#include <cstdint>
#include <optional>

#include "analysis/stability.h"
#include "app/messages.h"
#include "app/scene_control.h"
#include "aspic/run.h"
#include "playback/playback_session.h"

namespace aspic::app {

/// The scene's values go back and forth with time, for they are part of the run.
class RunControl {
 public:
  /// The references must outlive it.
  RunControl(PlaybackSession& simulation, SceneControl& scene, Messages& messages)
      : simulation_(simulation), scene_(scene), messages_(messages) {}

  void toggle();
  void single_step();
  void reset();
  void change_speed(double factor);
  /// Goes on with the next backend of the table that works here.
  void switch_backend();
  /// Compares with another backend; null ends that.
  void set_shadow(const BackendRow* backend);

  void step_back();
  /// To the moment nearest to a time of the history [s]; paused.
  void go_to(double time);
  void back_before_divergence();
  /// Continues from shortly before the divergence with the scene as it is now and the time step that is
  /// offered.
  void take_offered_step();

  /// Once for each image: reports a new divergence.
  void watch_divergence();
  /// Likewise: says what does not hold where a run starts, and once what comes about on the way.
  void watch_run();
  /// A smaller time step [s] than that which diverged, once a divergence was reported: step_to_try().
  std::optional<double> offered_step() const;

 private:
  PlaybackSession& simulation_;
  SceneControl& scene_;
  Messages& messages_;
  std::optional<StabilityLimit> stable_;
  std::optional<RunWatch> watch_;  // of the model with that number
  std::uint64_t watched_model_ = 0, next_look_ = 0;
  std::pair<std::uint64_t, std::uint64_t> watched_part_;  // the run's number and that of the stretch
};

}  // namespace aspic::app
