#include "playback/playback_session.h"

#include <utility>

#include "model/integrator.h"
#include "model/springs.h"

namespace aspic {

Result<std::unique_ptr<PlaybackSession>> PlaybackSession::create(gl::Context& context, const Scene& scene,
                                                                 const BackendRow& backend,
                                                                 const BackendChoice& asked) {
  const Setup setup = {scene.model, {}, {}};
  std::unique_ptr<PlaybackSession> s(new PlaybackSession(context, setup, asked));
  ASPIC_TRY(auto built, build_model(setup));
  const SharedModel model = shared(std::move(built));
  ASPIC_TRY(auto leader, s->factory_.make(model, backend, nullptr));
  ASPIC_CHECK(s->stepper_.install(setup, Engines(model, std::move(leader), {})));
  ASPIC_CHECK(s->rebuild_.reset());
  return s;
}

PlaybackSession::PlaybackSession(gl::Context& context, Setup setup, const BackendChoice& asked)
    : factory_(context, asked),
      present_(std::move(setup)),
      timeline_(present_),
      figures_(present_, timeline_, jobs_),
      stepper_(present_, timeline_, jobs_, figures_, factory_),
      playback_(present_, timeline_, jobs_, figures_, stepper_, factory_),
      rebuild_(present_, timeline_, jobs_, figures_, stepper_, playback_, factory_) {}

Status PlaybackSession::single_step() {
  if (running() || divergence()) return {};
  stepper_.ask_single_step();
  return stepper_.steps_quickly() ? settle() : Status();
}

Status PlaybackSession::update(double dt, double budget) {
  Status moved = jobs_.collect();
  if (moved) moved = move(dt, budget);
  return moved ? Status() : stepper_.fall_back(moved.error());
}

Status PlaybackSession::move(double dt, double budget) {
  const bool waits = rebuild_.requested() && !playback_.seeking();
  if (waits && jobs_.idle()) rebuild_.begin();
  if (rebuild_.building()) return {};
  if (playback_.seeking()) return playback_.go_on(budget);
  // A change that waits begins once the jobs are done.
  if (running() && !(waits && !present_.engines().only_context())) return stepper_.advance(dt, budget);
  if (stepper_.single_steps() > 0) return playback_.step_singly();
  if (running()) return {};
  // While paused, all figures are of the state that is shown.
  if (Engines::in_context(present_.engines().leader()) && snapshot().step != step())
    return refresh_snapshot();
  figures_.complete();
  return {};
}

double real_time_factor(const PlaybackSession& s) {
  return s.running() ? s.pacer().steps_per_second() * s.model().simulation.timestep : 0.0;
}

std::optional<double> spring_evaluations_per_second(const PlaybackSession& s) {
  const Integrator integrator = s.model().simulation.integrator;
  if (!row_of(integrator).staged()) return std::nullopt;
  return s.pacer().steps_per_second() * static_cast<double>(spring_count(s.model())) *
         force_evaluations_per_step(integrator);
}

}  // namespace aspic
