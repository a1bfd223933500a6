#include "playback/ghost_run.h"

#include <utility>

namespace aspic {
namespace {

/// What its keyframes may take.
constexpr std::uint64_t most_bytes = std::uint64_t{128} << 20;

}  // namespace

Result<std::unique_ptr<GhostRun>> GhostRun::create(gl::Context& context, const Scene& scene,
                                                   const PlaybackSession& of, const BackendChoice& asked) {
  std::unique_ptr<GhostRun> ghost(new GhostRun(scene));
  ASPIC_TRY(ghost->simulation_,
            PlaybackSession::create(context, ghost->scene_, of.present().backend(), asked));
  History history = of.playback().history();
  history.thin(most_bytes);
  ASPIC_CHECK(ghost->simulation_->playback().replay(std::move(history)));
  return ghost;
}

double GhostRun::end() const {
  const History& history = simulation_->playback().history();
  return history.time(history.end_moment());
}

Status GhostRun::follow(double time, const ViewSettings& view, double dt, double budget) {
  scene_.view = view;
  Playback& playback = simulation_->playback();
  const Moment moment = playback.history().nearest(time);
  if (!playback.seeking() && moment != playback.here()) ASPIC_CHECK(playback.seek(moment));
  ASPIC_CHECK(simulation_->update(dt, budget));
  arrived_ = !playback.seeking() && playback.here() == moment;
  return {};
}

}  // namespace aspic
