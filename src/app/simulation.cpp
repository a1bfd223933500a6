// What is simulated, and by whom: setups, backends, hands. simulation_run.cpp has what moves it.
#include "app/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aspic::app {
namespace {

constexpr std::uint64_t most_history_bytes = std::uint64_t{512} << 20;
/// Models of so many particles are built on another thread.
constexpr std::uint64_t many_particles = 20000;

std::uint64_t predict_particles(const Setup& setup) {
  return predict_counts(setup.settings).particles;
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(gl::Context& context, const Scene& scene,
                                                       const BackendRow& backend) {
  std::unique_ptr<Simulation> s(new Simulation(context));
  const Setup setup = {scene.model, {}, {}};
  auto model = build_model(setup);
  if (!model) return model.error();
  s->setup_ = setup;
  s->model_ = std::make_unique<Model>(std::move(*model));
  auto engine = s->make_engine(*s->model_, backend);
  if (!engine) return engine.error();
  s->engine_ = std::move(*engine);
  ASPIC_CHECK(s->reset());
  return s;
}

Simulation::Simulation(gl::Context& context) : context_(&context), history_(most_history_bytes) {}

Simulation::~Simulation() {
  worker_.abandon();
}

Result<Backend> Simulation::make_engine(const Model& model, const BackendRow& backend) {
  auto engine = make_backend({&backend, Precision::single, ForcePath::automatic}, model,
                             {context_, engine_.gpu ? engine_.gpu : shadow_.gpu, arithmetic_});
  if (engine && engine->gpu) arithmetic_ = engine->gpu->arithmetic();
  return engine;
}

/// Another model with solvers of the same kinds as now. Where the gpu refuses it the reference takes over.
/// Without solvers of the gpu it may run on another thread.
Result<Simulation::Built> Simulation::build(const Setup& setup) {
  auto model = build_model(setup);
  if (!model) return model.error();
  Built built;
  built.model = std::make_unique<Model>(std::move(*model));
  auto engine = make_engine(*built.model, backend());
  if (!engine && engine_.gpu) {
    built.message = fmt::format("{} The reference goes on.", engine.error().message);
    engine = make_engine(*built.model, reference_backend());
  } else if (engine && shadow_.solver) {
    auto other = make_engine(*built.model, *shadow_.row);
    if (!other) return other.error();
    built.shadow = std::move(*other);
  }
  if (!engine) return engine.error();
  built.engine = std::move(*engine);
  return built;
}

void Simulation::install(Setup setup, Built built) {
  // Solvers first: they refer to their model.
  engine_ = std::move(built.engine);
  shadow_ = std::move(built.shadow);
  model_ = std::move(built.model);
  if (built.message) message_ = std::move(built.message);
  setup_ = std::move(setup);
  given_.reset();
  batch_ = 1;
  ++model_number_;
}

/// On an error nothing changes.
Status Simulation::rebuild(Setup setup) {
  auto built = build(setup);
  if (!built) return built.error();
  install(std::move(setup), std::move(*built));
  return {};
}

Status Simulation::load(const State& state) {
  for (Backend* engine : {&engine_, &shadow_}) {
    if (!engine->solver) continue;
    ASPIC_CHECK(engine->solver->load(state));
  }
  snapshot_ = state;
  snapshot_time_ = Clock::now();
  step_ = state.step;
  divergence_.reset();
  due_ = 0.0;
  ++picture_number_;
  return {};
}

Status Simulation::change(const Scene& scene, bool keep_state) {
  wanted_change_.reset();
  Setup setup = setup_;
  setup.settings = scene.model;
  return change_setup(std::move(setup), keep_state);
}

void Simulation::request_change(const Scene& scene, bool keep_state) {
  wanted_change_ = {scene.model, keep_state};
}

/// Begins the change that was asked for; the worker is idle.
void Simulation::start_change() {
  Setup setup = setup_;
  const bool keep_state = wanted_change_->second;
  setup.settings = std::move(wanted_change_->first);
  wanted_change_.reset();
  const bool small =
      std::max<std::uint64_t>(model_->particle_count(), predict_particles(setup)) < many_particles;
  if (small || engine_.gpu || shadowed() || seek_) {
    change_result_ = change_setup(std::move(setup), keep_state);
    return;
  }
  change_ = begin_change(std::move(setup), keep_state);
  has_outcome_ = true;
  outcome_ = Outcome{};
  worker_.start([this](const std::atomic<bool>&) {
    outcome_.built = std::make_unique<Result<Built>>(build(change_->setup));
  });
}

Status Simulation::change_setup(Setup setup, bool keep_state) {
  ASPIC_CHECK(settle());
  Change change = begin_change(std::move(setup), keep_state);
  auto built = build(change.setup);
  return finish_change(std::move(change), std::move(built));
}

/// What is to be built, and the state it goes on from: snapshot_ is that of the step, and stays so.
Simulation::Change Simulation::begin_change(Setup setup, bool keep_state) const {
  Change change{std::move(setup), keep_state, snapshot_, model_->balls.size() - setup_.thrown.size()};
  if (!keep_state) {
    change.setup.thrown.clear();
    change.setup.pinned.clear();
  }
  const double h = setup_.settings.simulation.timestep, other = change.setup.settings.simulation.timestep;
  // Time goes on from where it was, in steps of the new length.
  if (const double t = time() / other; h != other && t < 0x1p62)
    change.state.step = static_cast<std::uint64_t>(std::llround(t));
  for (Ball& ball : change.setup.thrown) ball.launch_step = std::min(ball.launch_step, change.state.step);
  const std::size_t balls = change.scene_balls + std::min(change.setup.thrown.size(), setup_.thrown.size());
  change.state.ball_position.resize(balls);
  change.state.ball_velocity.resize(balls);
  change.state.ball_angular_velocity.resize(balls);
  return change;
}

Status Simulation::finish_change(Change change, Result<Built> built) {
  if (!built) return built.error();
  const bool fits = change.keep_state && built->model->particle_count() == change.state.position.size() &&
                    built->model->ball_count() - change.setup.thrown.size() == change.scene_balls;
  install(std::move(change.setup), std::move(*built));
  if (!fits) return reset();
  if (!at_end()) forget_future();
  const State state = grown_state(*model_, std::move(change.state));
  ASPIC_CHECK(load(state));
  history_.begin(setup_, state);
  stretch_ = history_.end_moment().stretch;
  ever_differed_ = false;
  return {};
}

Status Simulation::reset() {
  worker_.finish();
  if (change_) {
    ASPIC_CHECK(take_outcome());
  }
  has_outcome_ = false;
  seek_.reset();
  if (!setup_.thrown.empty() || !setup_.pinned.empty()) {
    ASPIC_CHECK(rebuild({setup_.settings, {}, {}}));
  }
  forget_past();
  const State start = initial_state(*model_, Precision::single);
  ASPIC_CHECK(load(start));
  history_.begin(setup_, start);
  stretch_ = history_.end_moment().stretch;
  add_sample(start, measure(*model_, start));
  return {};
}

void Simulation::forget_past() {
  history_.clear();
  energies_.clear();
  differences_.clear();
  ever_differed_ = false;
  hand_.reset();  // its particle may be no more
  last_remembered_ = {};
  rate_steps_ = 0;
  steps_per_second_ = 0.0;
}

Status Simulation::set_backend(const BackendRow& row) {
  if (&row == engine_.row) return {};
  ASPIC_CHECK(settle());
  const auto divergence = divergence_;
  if (shadow_.row == &row) {
    // Both are there, at the same step.
    std::swap(engine_, shadow_);
  } else {
    auto engine = make_engine(*model_, row);
    if (!engine) return engine.error();
    engine_ = std::move(*engine);
    given_.reset();
  }
  batch_ = 1;
  const Status loaded = load(State(snapshot_));
  divergence_ = divergence;
  return loaded;
}

Status Simulation::set_shadow(bool on) {
  if (on == shadowed()) return {};
  ASPIC_CHECK(settle());
  differences_.clear();
  ever_differed_ = false;
  if (!on) {
    shadow_ = {};
    return {};
  }
  const BackendRow& other =
      engine_.row == &reference_backend() ? next_backend(reference_backend()) : reference_backend();
  auto engine = make_engine(*model_, other);
  if (!engine) return engine.error();
  ASPIC_CHECK(engine->solver->load(snapshot_));
  shadow_ = std::move(*engine);
  given_.reset();
  return {};
}

/// The reference goes on from the last copy of a state that the gpu has lost.
Status Simulation::fall_back(const Error& error) {
  if (!engine_.gpu && !shadow_.gpu) return error;
  const bool gpu_led = engine_.gpu != nullptr;
  const std::uint64_t lost = gpu_led && step_ > snapshot_.step ? step_ - snapshot_.step : 0;
  const double age = std::chrono::duration<double>(Clock::now() - snapshot_time_).count();
  worker_.finish();
  has_outcome_ = false;
  if (gpu_led) {
    auto engine = make_engine(*model_, reference_backend());
    if (!engine) return engine.error();
    engine_ = std::move(*engine);
  }
  shadow_ = {};
  given_.reset();
  seek_.reset();
  if (!gpu_led) {
    message_ = fmt::format("{} Shadow mode has ended.", error.message);
    return load(State(snapshot_));  // the reference may be steps ahead of what was taken from it
  }
  if (snapshot_.step >= history_.stretch(stretch_).first && snapshot_.step < step_)
    history_.truncate({stretch_, snapshot_.step});
  message_ = fmt::format(
      "{} The reference goes on from the last copy, {:.2f} s old (t = {:.6g} s; {} steps are done again).",
      error.message, age, static_cast<double>(snapshot_.step) * model_->simulation.timestep, lost);
  return load(State(snapshot_));
}

Status Simulation::leave_gpu(const Error& why) {
  return engine_.gpu || shadow_.gpu ? fall_back(why) : Status();
}

void Simulation::set_context(gl::Context& context) {
  context_ = &context;
  arithmetic_.reset();
}

// ---- hands ----

Status Simulation::toggle_pin(std::uint32_t particle) {
  ASPIC_CHECK(settle());
  if (particle >= model_->particle_count()) return {};
  Setup setup = setup_;
  setup.pinned[particle] = model_->inverse_mass[particle] != 0.0;
  return change_setup(std::move(setup), true);
}

Status Simulation::throw_balls(const std::vector<BallSettings>& balls) {
  ASPIC_CHECK(settle());
  Setup setup = setup_;
  for (const BallSettings& b : balls)
    setup.thrown.push_back({b.radius, b.mass, step_, b.position, b.velocity, b.angular_velocity});
  return change_setup(std::move(setup), true);
}

Status Simulation::clear_balls() {
  ASPIC_CHECK(settle());
  if (setup_.thrown.empty()) return {};
  Setup setup = setup_;
  setup.thrown.clear();
  return change_setup(std::move(setup), true);
}

}  // namespace aspic::app
