#include "playback/variant_run.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "model/steps.h"
#include "playback/effect.h"
#include "variants/common_clock.h"

namespace aspic {
Result<std::unique_ptr<VariantRun>> VariantRun::create(gl::Context& context, const Scene& scene,
                                                       const PlaybackSession& leader,
                                                       const BackendChoice& asked,
                                                       const Difference& difference) {
  std::unique_ptr<VariantRun> made(new VariantRun(difference, asked));
  BackendChoice choice = asked;
  choice.row = &leader.present().backend();
  ASPIC_TRY(auto run, varied(scene, choice, std::span(&difference, 1)));
  made->own_backend_ = difference.key == backend_key;
  made->scene_ = std::move(run.scene);
  ASPIC_TRY(
      made->simulation_,
      PlaybackSession::create(context, made->scene_,
                              run.backend.row ? *run.backend.row : leader.present().backend(), run.backend));
  made->leader_run_ = leader.present().run_number();
  made->leader_view_ = scene.view;
  made->adopted_ = false;
  return made;
}

/// Inputs on what is here too.
Inputs VariantRun::fitting(const PlaybackSession& leader, Inputs inputs) const {
  const bool balls = simulation_->model().ball_count() == leader.model().ball_count();
  const bool particles = has_particles_of(leader);
  std::erase_if(inputs.pulls, [&](const Pull& pull) { return pull.ball ? !balls : !particles; });
  if (!particles) inputs.pinned.clear(), inputs.released.clear();
  return inputs;
}

std::uint64_t VariantRun::step_at(double time) const {
  return nearest_step(time, simulation_->model().simulation.timestep);
}

/// The run restarted, or is another one: so is this one.
Status VariantRun::take_over(const Scene& scene, const PlaybackSession& leader) {
  PlaybackSession& own = *simulation_;
  if (!own_backend_ && &leader.present().backend() != &own.present().backend())
    ASPIC_CHECK(own.rebuild().set_backend(leader.present().backend()));
  if (adopted_model_ != leader.present().model_number()) {
    adopted_model_ = leader.present().model_number();
    adopted_ = false;
  }
  if (leader_run_ != leader.present().run_number()) {
    leader_run_ = leader.present().run_number();
    ASPIC_CHECK(own.rebuild().reset());
  }
  // A change of the view needs no other solver.
  if (scene.view == leader_view_) return {};
  leader_view_ = scene.view;
  const auto run = varied(scene, asked_, std::span(&difference_, 1));
  if (run) scene_.view = run->scene.view;
  return {};
}

/// The leader's scene with the difference, and its hands, from the time at which it got them.
Status VariantRun::adopt_setup(const PlaybackSession& leader) {
  PlaybackSession& own = *simulation_;
  adopted_ = true;
  Scene base = scene_;
  base.model = leader.present().setup().settings;
  auto run = varied(base, asked_, std::span(&difference_, 1));
  if (!run) {
    message_ = run.error();
    return {};
  }
  const Effect effect = effect_between(scene_, run->scene);
  Setup setup = {run->scene.model, leader.present().setup().thrown, leader.present().setup().pinned};
  const double ratio = leader.model().simulation.timestep / setup.settings.simulation.timestep;
  for (Ball& ball : setup.thrown)
    ball.launch_step = nearest_step(static_cast<double>(ball.launch_step) * ratio, 1.0);
  if (!has_particles_of(leader)) setup.pinned.clear();
  const bool hands = setup.pinned != own.present().setup().pinned ||
                     setup.thrown.size() != own.present().setup().thrown.size();
  scene_ = std::move(run->scene);
  return effect >= Effect::constants || hands
             ? own.rebuild().adopt(std::move(setup), effect < Effect::restart)
             : Status();
}

/// Where the history has it, there; else forward from the end, or from here if nothing was before.
Status VariantRun::go_to(std::uint64_t step) {
  PlaybackSession& own = *simulation_;
  stuck_ = false;
  own.pacer().catch_up(true);
  if (own.playback().seeking()) return {};
  if (step < own.step()) {
    own.pacer().limit(Hold::comparison, std::nullopt);
    const Moment moment =
        own.playback().history().nearest(static_cast<double>(step) * own.model().simulation.timestep);
    stuck_ = moment == own.playback().here();
    return stuck_ ? Status() : own.playback().seek(moment);
  }
  // A job on its way goes where it was sent, with the inputs of that time.
  if (own.running() && own.busy() && own.pacer().limit()) return {};
  own.pacer().limit(Hold::comparison, step);
  if (step > own.step() && !own.running() && !own.divergence()) own.set_running(true);
  return {};
}

Status VariantRun::follow(const Scene& scene, const PlaybackSession& leader, double dt, double budget) {
  PlaybackSession& own = *simulation_;
  arrived_ = false;
  ASPIC_CHECK(take_over(scene, leader));
  const History& history = leader.playback().history();
  const Moment here = leader.playback().here();
  if (!leader.playback().at_end()) {
    // In the past every run follows its own history.
    ASPIC_CHECK(recall(leader.time(), dt, budget));
    arrived_ = arrived_ && !leader.playback().seeking();
    return {};
  }
  std::uint64_t wanted = step_at(leader.time());
  if (!adopted_ && !leader.playback().seeking()) {
    const std::uint64_t begins = step_at(history.time({here.stretch, history.stretch(here.stretch).first}));
    if (own.step() == begins || own.divergence())
      ASPIC_CHECK(adopt_setup(leader));
    else
      wanted = begins;
  }
  if (adopted_) {
    // What acts on the leader acts here, from the same time to the same time.
    const Moment then = {here.stretch,
                         std::clamp(nearest_step(own.time(), leader.model().simulation.timestep),
                                    history.stretch(here.stretch).first, here.step)};
    own.stepper().acts().followed = fitting(leader, history.inputs_at(then));
    if (const auto next = history.next_input_change(then))
      wanted = std::min(wanted, std::max(step_at(history.time({here.stretch, *next})), own.step() + 1));
  }
  ASPIC_CHECK(go_to(wanted));
  rest(wanted, !leader.running());
  ASPIC_CHECK(own.update(dt, budget));
  const bool there = own.step() == step_at(leader.time()) && !own.playback().seeking();
  arrived_ = adopted_ && (there || stuck_ || own.divergence());
  return {};
}

/// Where the others pause at the step that it has come to, so does this: paused runs have figures of the very
/// state that is shown.
void VariantRun::rest(std::uint64_t step, bool paused) {
  PlaybackSession& own = *simulation_;
  if (paused && own.running() && own.step() == step && !own.busy()) own.set_running(false);
}

Status VariantRun::recall(double time, double dt, double budget) {
  PlaybackSession& own = *simulation_;
  own.stepper().acts().followed = {};
  const Moment moment = own.playback().history().nearest(time);
  if (!own.playback().seeking() && moment != own.playback().here()) ASPIC_CHECK(own.playback().seek(moment));
  ASPIC_CHECK(own.update(dt, budget));
  arrived_ = !own.playback().seeking() && own.playback().here() == moment;
  return {};
}

Status VariantRun::go_on_to(double time, bool paused, double dt, double budget) {
  PlaybackSession& own = *simulation_;
  own.stepper().acts().followed = {};
  const std::uint64_t wanted = step_at(time);
  ASPIC_CHECK(go_to(wanted));
  rest(wanted, paused);
  ASPIC_CHECK(own.update(dt, budget));
  arrived_ = (own.step() == wanted && !own.playback().seeking()) || stuck_ || own.divergence();
  return {};
}

Status VariantRun::lead(const Pacer& pace, bool running, bool waits, double dt, double budget) {
  PlaybackSession& own = *simulation_;
  own.stepper().acts().followed = {};
  own.pacer().catch_up(false);
  own.pacer().set_pace(pace.pace());
  own.pacer().set_speed(pace.speed());
  own.pacer().limit(Hold::comparison, waits ? std::optional(own.step()) : std::nullopt);
  if (own.running() != running) own.set_running(running);
  ASPIC_CHECK(own.update(dt, budget));
  arrived_ = true;
  return {};
}

}  // namespace aspic
