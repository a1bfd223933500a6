#pragma once
// One of the runs compared: the scene with a difference, on the clock of the scene's own run.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "aspic/scene.h"
#include "base/result.h"
#include "playback/playback_session.h"
#include "variants/variant.h"

namespace aspic {

class VariantRun {
 public:
  /// `scene` is that of the leader, the scene's own run; all but the difference is taken from them. Errors:
  /// those of varied() and of Simulation::create().
  static Result<std::unique_ptr<VariantRun>> create(gl::Context& context, const Scene& scene,
                                                    const PlaybackSession& leader, const BackendChoice& asked,
                                                    const Difference& difference);

  const Difference& difference() const { return difference_; }
  const Scene& scene() const { return scene_; }
  const PlaybackSession& simulation() const { return *simulation_; }
  PlaybackSession& simulation() { return *simulation_; }

  /// Once for each image: follows the leader to its time, resets and changes included. `dt` and `budget` as
  /// of Simulation::update(). Errors: those of Simulation.
  Status follow(const Scene& scene, const PlaybackSession& leader, double dt, double budget);
  /// Goes to a time [s] that only runs like this one have come to, and rests there if those have `paused`.
  Status go_on_to(double time, bool paused, double dt, double budget);
  /// Goes to the moment of its own history that is nearest to a time [s].
  Status recall(double time, double dt, double budget);
  /// Sets the pace itself, that of `pace`; it `waits` for the others.
  Status lead(const Pacer& pace, bool running, bool waits, double dt, double budget);
  /// It shows the time it was last asked for, or diverged on the way there.
  bool arrived() const { return arrived_; }
  /// Its bodies have the particles of the leader's: what hands do to one can be done to it.
  bool has_particles_of(const PlaybackSession& leader) const {
    return simulation_->model().particle_count() == leader.model().particle_count();
  }
  /// Why it does not do what its leader does, once.
  std::optional<Error> take_message() { return std::exchange(message_, std::nullopt); }

 private:
  VariantRun(const Difference& difference, const BackendChoice& asked)
      : difference_(difference), asked_(asked) {}
  Status take_over(const Scene& scene, const PlaybackSession& leader);
  Status adopt_setup(const PlaybackSession& leader);
  Status go_to(std::uint64_t step);
  void rest(std::uint64_t step, bool paused);
  Inputs fitting(const PlaybackSession& leader, Inputs inputs) const;
  std::uint64_t step_at(double time) const;

  Difference difference_;
  BackendChoice asked_;
  Scene scene_;  // the variant's
  std::unique_ptr<PlaybackSession> simulation_;
  bool own_backend_ = false;  // the difference says which
  bool arrived_ = false;
  bool stuck_ = false;   // its history does not reach the time it was asked for
  bool adopted_ = true;  // the leader's setup of adopted_model_
  ViewSettings leader_view_;
  std::uint64_t leader_run_ = 0, adopted_model_ = 0;
  std::optional<Error> message_;
};

}  // namespace aspic
