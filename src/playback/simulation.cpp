// The simulated setup and its backends: setups, backends, hands. simulation_run.cpp advances it.
#include "playback/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

constexpr std::uint64_t most_history_bytes = std::uint64_t{512} << 20;
/// Models of so many particles are built on another thread.
constexpr std::uint64_t long_to_build = 20000;

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(gl::Context& context, const Scene& scene,
                                                       const BackendRow& backend,
                                                       const BackendChoice& asked) {
  std::unique_ptr<Simulation> s(new Simulation(context, {scene.model, {}, {}}, asked));
  ASPIC_TRY(auto built, build_model(s->setup_));
  const SharedModel model = shared(std::move(built));
  ASPIC_TRY(auto leader, s->factory_.make(model, backend, nullptr));
  s->engines_ = Engines(model, std::move(leader), {});
  ASPIC_CHECK(s->reset());
  return s;
}

Simulation::Simulation(gl::Context& context, Setup setup, const BackendChoice& asked)
    : setup_(std::move(setup)), factory_(context, asked), history_(most_history_bytes) {}

/// On an error nothing changes.
Status Simulation::install(Setup setup, Result<Engines> engines) {
  if (!engines) return engines.error();
  engines_ = std::move(*engines);
  if (engines_.departure) message_ = engines_.departure;
  setup_ = std::move(setup);
  if (hand_ && hand_->particle >= (hand_->ball ? model().ball_count() : model().particle_count()))
    hand_.reset();  // what it held is no more
  batch_ = sample_stride_ = 1;
  ++model_number_;
  return {};
}

Status Simulation::load(const State& state) {
  ASPIC_CHECK(engines_.load(state));
  take_snapshot(State(state));
  step_ = state.step;
  divergence_.reset();
  pacer_.drop_due();
  ++picture_number_;
  return {};
}

Status Simulation::change(const Scene& scene, bool keep_state) {
  requested_.reset();
  Setup setup = setup_;
  setup.settings = scene.model;
  return change_setup(std::move(setup), keep_state);
}

void Simulation::request_change(const Scene& scene, bool keep_state) {
  requested_ = {scene.model, keep_state};
}

/// Begins the change that was asked for; the worker is idle.
void Simulation::start_change() {
  Setup setup = setup_;
  const bool keep_state = requested_->second;
  setup.settings = std::move(requested_->first);
  requested_.reset();
  const std::uint64_t particles =
      std::max<std::uint64_t>(model().particle_count(), predict_counts(setup.settings).particles);
  if (particles < long_to_build || engines_.use_context()) {
    change_result_ = change_setup(std::move(setup), keep_state);
    return;
  }
  change_ = begin_change(std::move(setup), keep_state);
  progress_ = Clock::now();
  worker_.start([this](const std::atomic<bool>&) {
    change_->engines = factory_.make_like(engines_, change_->setup);
    outcomes_.put(JobResult());
  });
}

Status Simulation::change_setup(Setup setup, bool keep_state) {
  // Another start has no use for the end of a way through history.
  if (!keep_state) seek_.reset();
  ASPIC_CHECK(halt(true));
  Change change = begin_change(std::move(setup), keep_state);
  change.engines = factory_.make_like(engines_, change.setup);
  return finish_change(std::move(change));
}

/// The setup to be built, and the state it continues from: snapshot_ is that of the step, and stays so.
Simulation::Change Simulation::begin_change(Setup setup, bool keep_state) const {
  Change change{std::move(setup), keep_state, snapshot_, model().balls.size() - setup_.thrown.size()};
  if (!keep_state) {
    change.setup.thrown.clear();
    change.setup.pinned.clear();
  }
  const double h = setup_.settings.simulation.timestep, other = change.setup.settings.simulation.timestep;
  // Time continues from where it was, in steps of the new length.
  if (const double t = time() / other; h != other && t < 0x1p62)
    change.state.step = static_cast<std::uint64_t>(std::llround(t));
  for (Ball& ball : change.setup.thrown) ball.launch_step = std::min(ball.launch_step, change.state.step);
  const std::size_t balls = change.scene_balls + std::min(change.setup.thrown.size(), setup_.thrown.size());
  change.state.ball_position.resize(balls);
  change.state.ball_velocity.resize(balls);
  change.state.ball_angular_velocity.resize(balls);
  return change;
}

Status Simulation::finish_change(Change change) {
  const std::size_t thrown = change.setup.thrown.size();
  const double now = time();  // by the old time step, as all samples are
  ASPIC_CHECK(install(std::move(change.setup), std::move(*change.engines)));
  if (!change.keep_state || model().particle_count() != change.state.position.size() ||
      model().ball_count() - thrown != change.scene_balls)
    return reset();
  if (!at_end()) forget_future(now);
  samples_.clear_differed();
  ASPIC_CHECK(begin_history(grown_state(model(), std::move(change.state))));
  samples_.truncate(std::nextafter(time(), -1.0));  // with other constants this state has another energy
  return {};
}

/// The run continues with this state and setup.
Status Simulation::begin_history(const State& state) {
  ended_.reset();
  ASPIC_CHECK(load(state));
  history_.begin(setup_, state);
  stretch_ = history_.end_moment().stretch;
  return {};
}

Status Simulation::reset() {
  worker_.finish();
  if (change_) {
    ASPIC_CHECK(collect());
  }
  outcomes_.clear();
  seek_.reset();
  single_steps_ = 0;
  if (!setup_.thrown.empty() || !setup_.pinned.empty()) {
    const Setup setup = {setup_.settings, {}, {}};
    ASPIC_CHECK(install(setup, factory_.make_like(engines_, setup)));
  }
  ++run_number_;
  history_.clear();
  samples_.clear();
  pacer_.restart();
  hand_.reset();  // its particle may be no more
  last_remembered_ = {};
  const State start = initial_state(model(), Precision::single);
  ASPIC_CHECK(begin_history(start));
  remember(start, {engines_.measured(start)});
  return {};
}

Status Simulation::start_from(const State& state) {
  ASPIC_CHECK(halt(true));
  ++run_number_;
  history_.clear();
  samples_.clear();
  pacer_.restart();
  last_remembered_ = {};
  ASPIC_CHECK(begin_history(state));
  remember(snapshot_, {engines_.measured(snapshot_)});
  return {};
}

Status Simulation::set_backend(const BackendRow& row) {
  if (&row == &backend()) return {};
  ASPIC_CHECK(halt());
  const auto divergence = divergence_;
  if (shadow_backend() == &row) {
    engines_.swap();  // both are at the same step
  } else {
    ASPIC_TRY(auto engine, factory_.make(engines_.shared_model(), row, engines_.gpu()));
    engines_.set_leader(std::move(engine));
  }
  batch_ = 1;
  const Status loaded = load(State(snapshot_));
  divergence_ = divergence;
  return loaded;
}

Status Simulation::set_shadow(const BackendRow* row) {
  if (row == shadow_backend()) return {};
  ASPIC_CHECK(halt());
  samples_.clear_differences();
  engines_.set_shadow({});
  if (!row) return {};
  ASPIC_TRY(auto engine, factory_.make(engines_.shared_model(), *row, engines_.gpu()));
  ASPIC_CHECK(engine.solver->load(snapshot_));
  engines_.set_shadow(std::move(engine));
  return {};
}

/// The reference continues from the last copy of a state that was lost with the context.
Status Simulation::fall_back(const Error& error) {
  if (!engines_.use_context()) return error;
  worker_.finish();
  outcomes_.clear();
  engines_.set_shadow({});
  seek_.reset();
  if (!Engines::in_context(engines_.leader())) {
    message_ = fmt::format("{} Shadow mode has ended.", error.message);
    return load(State(snapshot_));  // the leader may be steps ahead of what was taken from it
  }
  ASPIC_TRY(auto engine, factory_.make(engines_.shared_model(), reference_backend(), nullptr));
  engines_.set_leader(std::move(engine));
  const double age = std::chrono::duration<double>(Clock::now() - snapshot_time_).count();
  const std::uint64_t lost = step_ > snapshot_.step ? step_ - snapshot_.step : 0;
  if (snapshot_.step >= history_.stretch(stretch_).first && snapshot_.step < step_)
    history_.truncate({stretch_, snapshot_.step});
  message_ = fmt::format(
      "{} The reference continues from the last copy, {:.2f} s old (t = {:.6g} s; {} steps are repeated).",
      error.message, age, static_cast<double>(snapshot_.step) * model().simulation.timestep, lost);
  return load(State(snapshot_));
}

std::optional<DeviceState> Simulation::device_state() const {
  const GpuSolver* const gpu = gpu_of(engines_.leader());
  if (!gpu) return std::nullopt;
  return gpu->device_state();
}

// ---- hands ----

Status Simulation::toggle_pin(std::uint32_t particle) {
  ASPIC_CHECK(halt(true));
  if (particle >= model().particle_count()) return {};
  Setup setup = setup_;
  setup.pinned[particle] = model().inverse_mass[particle] != 0.0;
  return change_setup(std::move(setup), true);
}

Status Simulation::throw_balls(const std::vector<BallSettings>& balls) {
  ASPIC_CHECK(halt(true));
  Setup setup = setup_;
  for (const BallSettings& b : balls)
    setup.thrown.push_back({b.radius, b.mass, step_, b.position, b.velocity, b.angular_velocity});
  return change_setup(std::move(setup), true);
}

Status Simulation::clear_balls() {
  ASPIC_CHECK(halt(true));
  if (setup_.thrown.empty()) return {};
  Setup setup = setup_;
  setup.thrown.clear();
  return change_setup(std::move(setup), true);
}

}  // namespace aspic
