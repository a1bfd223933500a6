#include "playback/rebuild.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "model/counts.h"
#include "model/inputs.h"

namespace aspic {
namespace {

/// Models of so many particles are built on another thread.
constexpr std::uint64_t long_to_build = 20000;

}  // namespace

// ---- the setup ----

Status Rebuild::change(const Scene& scene, bool keep_state) {
  Setup setup = present_.setup();
  setup.settings = scene.model;
  return adopt(std::move(setup), keep_state);
}

void Rebuild::request(const Scene& scene, bool keep_state) {
  request_ = {scene.model, keep_state, playback_.seeks()};
}

Status Rebuild::adopt(Setup setup, bool keep_state) {
  request_.reset();
  return change_setup(std::move(setup), keep_state);
}

void Rebuild::begin() {
  Setup setup = present_.setup();
  const bool keep_state = request_->keep_state;
  setup.settings = std::move(request_->settings);
  request_.reset();
  const std::uint64_t particles =
      std::max<std::uint64_t>(present_.model().particle_count(), predict_counts(setup.settings).particles);
  if (particles < long_to_build) {
    change_result_ = change_setup(std::move(setup), keep_state);
    return;
  }
  if (const Status read = stepper_.refresh_snapshot(); !read) {
    change_result_ = read;
    return;
  }
  const auto change = std::make_shared<Change>(begin_change(std::move(setup), keep_state));
  const bool with_engines = !present_.engines().use_context();
  building_ = true;
  jobs_.start_uncanceled([this, change, with_engines](const std::atomic<bool>&) -> Jobs::TakeUp {
    const auto built = std::make_shared<Result<Built>>(build(*change, with_engines));
    return [this, change, built] {
      building_ = false;
      change_result_ = finish_change(std::move(*change), std::move(*built));
      return Status();
    };
  });
}

Status Rebuild::change_setup(Setup setup, bool keep_state) {
  // Another start has no use for the end of a way through history.
  if (!keep_state) timeline_.stop();
  ASPIC_CHECK(playback_.halt(true));
  Change change = begin_change(std::move(setup), keep_state);
  auto built = build(change, true);
  return finish_change(std::move(change), std::move(built));
}

/// On the run's thread, or on another one if nothing here needs the context; the present model stays.
Result<Rebuild::Built> Rebuild::build(const Change& change, bool with_engines) {
  Built built;
  ASPIC_TRY(auto model, build_model(change.setup));
  built.model = shared(std::move(model));
  built.constants = change.keep_state && check_same_topology(present_.model(), *built.model);
  if (!built.constants && with_engines) {
    ASPIC_TRY(built.engines, factory_.make_like(present_.engines(), built.model));
  }
  return built;
}

/// The solvers go over to the setup.
Status Rebuild::change_constants(const Change& change, SharedModel model) {
  const double now = present_.time();  // by the old time step, as all samples are
  const bool same_state = change.state.step == present_.snapshot().step &&
                          same_pins(present_.model(), *model) && !present_.divergence();
  ASPIC_CHECK(present_.set_constants(change.setup, std::move(model)));
  if (!timeline_.at_end()) stepper_.forget_future(now);
  figures_.samples().clear_differed();
  if (same_state) {
    stepper_.pacer().drop_due();
    present_.redraw();
    timeline_.begin(present_.snapshot(), true);
  } else {
    ASPIC_CHECK(begin_stretch(grown_state(present_.model(), State(change.state))));
  }
  // With other constants this state has another energy.
  figures_.samples().truncate(std::nextafter(present_.time(), -1.0));
  return {};
}

/// The setup to be built, and the state it continues from: the snapshot is that of the step, and stays so.
Rebuild::Change Rebuild::begin_change(Setup setup, bool keep_state) const {
  const Setup& now = present_.setup();
  Change change{std::move(setup), keep_state, present_.snapshot(),
                present_.model().balls.size() - now.thrown.size()};
  if (!keep_state) {
    change.setup.thrown.clear();
    change.setup.pinned.clear();
  }
  // Time continues from where it was, in steps of the new length.
  change.state.step = step_at_same_time(change.state.step, now.settings.simulation.timestep,
                                        change.setup.settings.simulation.timestep);
  for (Ball& ball : change.setup.thrown) ball.launch_step = std::min(ball.launch_step, change.state.step);
  const std::size_t balls = change.scene_balls + std::min(change.setup.thrown.size(), now.thrown.size());
  change.state.ball_position.resize(balls);
  change.state.ball_velocity.resize(balls);
  change.state.ball_angular_velocity.resize(balls);
  return change;
}

Status Rebuild::finish_change(Change change, Result<Built> built) {
  if (!built) return built.error();
  if (built->constants) return change_constants(change, std::move(built->model));
  const std::size_t thrown = change.setup.thrown.size();
  const double now = present_.time();  // by the old time step, as all samples are
  if (!built->engines) {
    ASPIC_TRY(built->engines, factory_.make_like(present_.engines(), built->model));
  }
  ASPIC_CHECK(stepper_.install(std::move(change.setup), std::move(*built->engines)));
  const Model& model = present_.model();
  if (!change.keep_state || model.particle_count() != change.state.position.size() ||
      model.ball_count() - thrown != change.scene_balls)
    return reset();
  if (!timeline_.at_end()) stepper_.forget_future(now);
  figures_.samples().clear_differed();
  ASPIC_CHECK(begin_stretch(grown_state(model, std::move(change.state))));
  // With other constants this state has another energy.
  figures_.samples().truncate(std::nextafter(present_.time(), -1.0));
  return {};
}

/// The run continues with this state and the present setup.
Status Rebuild::begin_stretch(const State& state) {
  ASPIC_CHECK(stepper_.load(state));
  timeline_.begin(state);
  return {};
}

void Rebuild::forget_run() {
  present_.begin_run();
  timeline_.clear();
  figures_.samples().clear();
  stepper_.pacer().restart();
}

Status Rebuild::reset() {
  jobs_.finish();
  if (building_) ASPIC_CHECK(jobs_.collect());
  jobs_.forget();
  timeline_.stop();
  stepper_.drop_single_steps();
  const Setup& now = present_.setup();
  if (!now.thrown.empty() || !now.pinned.empty()) {
    const Setup setup = {now.settings, {}, {}};
    ASPIC_CHECK(stepper_.install(setup, factory_.make_like(present_.engines(), setup)));
  }
  forget_run();
  stepper_.acts().hand.reset();  // its particle may be no more
  stepper_.acts().channels.clear();
  stepper_.forget_resumed();
  const State start = initial_state(present_.model(), present_.engines().leader().solver->precision());
  ASPIC_CHECK(begin_stretch(start));
  figures_.remember(start, {present_.engines().measured(start)});
  return {};
}

Status Rebuild::start_from(const State& state, InputLog inputs) {
  ASPIC_CHECK(playback_.halt(true));
  ASPIC_CHECK(check_sizes(present_.model(), state));
  const Setup& now = present_.setup();
  const Setup setup = {now.settings, {}, {}};
  if (!now.thrown.empty() || !now.pinned.empty())
    ASPIC_CHECK(stepper_.install(setup, factory_.make_like(present_.engines(), setup)));
  forget_run();
  stepper_.acts().channels.clear();
  stepper_.resume(std::move(inputs));
  ASPIC_CHECK(begin_stretch(grown_state(present_.model(), state)));
  figures_.remember(present_.snapshot(), {present_.engines().measured(present_.snapshot())});
  return {};
}

// ---- hands ----

Status Rebuild::toggle_pin(std::uint32_t particle) {
  ASPIC_CHECK(playback_.halt(true));
  const Model& model = present_.model();
  if (particle >= model.particle_count()) return {};
  Setup setup = present_.setup();
  setup.pinned[particle] = inverse_mass_of(model, stepper_.inputs(), particle) != 0.0;
  return change_setup(std::move(setup), true);
}

Status Rebuild::throw_balls(const std::vector<BallSettings>& balls) {
  ASPIC_CHECK(playback_.halt(true));
  Setup setup = present_.setup();
  for (const BallSettings& b : balls)
    setup.thrown.push_back({b.radius, b.mass, present_.step(), b.position, b.velocity, b.angular_velocity});
  return change_setup(std::move(setup), true);
}

Status Rebuild::clear_balls() {
  ASPIC_CHECK(playback_.halt(true));
  if (present_.setup().thrown.empty()) return {};
  Setup setup = present_.setup();
  setup.thrown.clear();
  return change_setup(std::move(setup), true);
}

// ---- the solvers ----

Status Rebuild::set_backend(const BackendRow& row) {
  if (&row == &present_.backend()) return {};
  ASPIC_CHECK(playback_.halt(false));
  const auto divergence = present_.divergence();
  Engines& engines = present_.engines();
  if (engines.shadow().row == &row) {
    engines.swap();  // both are at the same step
  } else {
    ASPIC_TRY(auto engine, factory_.make(engines.shared_model(), row, engines.gpu()));
    engines.set_leader(std::move(engine));
  }
  stepper_.leader_changed();
  const Status loaded = stepper_.load(State(present_.snapshot()));
  present_.set_divergence(divergence);
  return loaded;
}

Status Rebuild::set_shadow(const BackendRow* row) {
  Engines& engines = present_.engines();
  if (row == engines.shadow().row) return {};
  ASPIC_CHECK(playback_.halt(false));
  figures_.samples().clear_differences();
  engines.set_shadow({});
  if (!row) return {};
  ASPIC_TRY(auto engine, factory_.make(engines.shared_model(), *row, engines.gpu()));
  ASPIC_CHECK(engine.solver->load(present_.snapshot()));
  engines.set_shadow(std::move(engine));
  return {};
}

Status Rebuild::leave_context(const Error& why) {
  return present_.engines().use_context() ? stepper_.fall_back(why) : Status();
}

}  // namespace aspic
