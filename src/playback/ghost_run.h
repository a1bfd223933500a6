#pragma once
// An earlier run, which its history makes again next to the present one.
#include <cstdint>
#include <memory>
#include <string>

#include "aspic/scene.h"
#include "base/result.h"
#include "playback/playback_session.h"

namespace aspic {

class GhostRun {
 public:
  /// The run so far of `of`, which is halted; `scene` is its scene. Errors: those of Simulation::create() and
  /// Playback::replay().
  static Result<std::unique_ptr<GhostRun>> create(gl::Context& context, const Scene& scene,
                                                  const PlaybackSession& of, const BackendChoice& asked);

  const Scene& scene() const { return scene_; }
  PlaybackSession& simulation() { return *simulation_; }
  const PlaybackSession& simulation() const { return *simulation_; }
  /// The last time that it has come to [s].
  double end() const;
  /// To a time [s], or as near as its run has come to, seen as `view` says. Errors: those of Simulation.
  Status follow(double time, const ViewSettings& view, double dt, double budget);
  /// It is there.
  bool arrived() const { return arrived_; }

 private:
  explicit GhostRun(const Scene& scene) : scene_(scene) {}
  Scene scene_;
  std::unique_ptr<PlaybackSession> simulation_;
  bool arrived_ = false;
};

}  // namespace aspic
