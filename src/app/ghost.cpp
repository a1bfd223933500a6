// The ghost of an earlier run, in the picture of the window's own.
#include <fmt/format.h>

#include <utility>

#include "app/beside.h"

namespace aspic::app {
namespace {

/// What the keyframes of a ghost may take.
constexpr std::uint64_t most_ghost_bytes = std::uint64_t{128} << 20;

}  // namespace

void Beside::keep_ghost() {
  // Another gets what this one has.
  ghost_.reset();
  if (!messages_.check(leader_.halt(true))) return;
  auto ghost = std::make_unique<Ghost>();
  ghost->scene = scene_.scene();
  ghost->source = scene_.editor().source();
  auto made = Simulation::create(*context_, ghost->scene, leader_.present().backend(), asked_);
  if (!messages_.check(made)) return;
  ghost->simulation = std::move(*made);
  History history = leader_.playback().history();
  history.thin(most_ghost_bytes);
  if (!messages_.check(ghost->simulation->playback().replay(std::move(history)))) return;
  ghost->picture =
      std::make_unique<ScenePicture>(*ghost->simulation, ghost->scene, view_, picture_.full_quality);
  ghost->picture->ghost = true;
  if (!messages_.check(ghost->picture->attach(*context_))) return;
  ghost_ = std::move(ghost);
  settled_ = false;
  shown_.clear();
  messages_.info(
      fmt::format("This run is the ghost from now on, up to t = {:.3f} s. Change something and press Reset.",
                  ghost_end()));
}

void Beside::remove_ghost() {
  ghost_.reset();
  if (!several()) end_waiting();
}

double Beside::ghost_end() const {
  const History& history = ghost_->simulation->playback().history();
  return history.time(history.end_moment());
}

/// To the time that is shown, or as near as its run has come to.
Status Beside::follow_with_ghost(double time, double dt, double budget) {
  Simulation& run = *ghost_->simulation;
  ghost_->scene.view = scene_.scene().view;
  const Moment moment = run.playback().history().nearest(time);
  if (!run.playback().seeking() && moment != run.playback().here()) ASPIC_CHECK(run.playback().seek(moment));
  ASPIC_CHECK(run.update(dt, budget));
  ghost_->arrived = !run.playback().seeking() && run.playback().here() == moment;
  settled_ = settled_ && ghost_->arrived;
  return {};
}

}  // namespace aspic::app
