#include "app/simulation.h"

#include <algorithm>
#include <cmath>

#include "cli/backends.h"
#include "cpu_reference/reference_solver.h"
#include "model/integrator.h"

namespace aspic::app {
namespace {

constexpr std::size_t most_samples = 2000;
constexpr std::size_t most_remembered = 20;
constexpr std::uint64_t most_remembered_bytes = std::uint64_t{256} << 20;
constexpr auto remember_every = std::chrono::milliseconds(500);
constexpr auto sample_every = std::chrono::milliseconds(100);
/// Nobody waits for a job, so it may take longer than a picture [s].
constexpr double shortest_job = 0.030;
constexpr double rate_window = 0.5;  // s

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Result<std::unique_ptr<Simulation>> Simulation::create(gl::Context& context, const Scene& scene,
                                                       BackendName backend) {
  std::unique_ptr<Simulation> s(new Simulation(context));
  auto model = build_model(scene.model);
  if (!model) return model.error();
  s->model_ = std::make_unique<Model>(std::move(*model));
  auto made = s->make_solver(*s->model_, backend);
  if (!made) return made.error();
  s->install(std::move(*made));
  if (const Status ready = s->reset(); !ready) return ready.error();
  return s;
}

Simulation::~Simulation() {
  worker_.finish();
}

Result<Simulation::Made> Simulation::make_solver(const Model& model, BackendName backend) {
  Made made;
  if (backend == BackendName::gpu) {
    auto directory = cli::shader_directory();
    if (!directory) return directory.error();
    GpuOptions options;
    options.shader_directory = std::move(*directory);
    // The device does not change: what the canary found once holds.
    if (gpu_) options.arithmetic = gpu_->arithmetic();
    options.like = gpu_;
    auto solver = make_gpu_solver(context_, model, options);
    if (!solver) return solver.error();
    made.gpu = solver->get();
    made.solver = std::move(*solver);
  } else {
    auto solver = make_reference_solver(model, Precision::single);
    if (!solver) return solver.error();
    made.solver = std::move(*solver);
  }
  return made;
}

void Simulation::install(Made made) {
  solver_ = std::move(made.solver);
  gpu_ = made.gpu;
  batch_ = 1;
}

Status Simulation::load(const State& state) {
  if (const Status loaded = solver_->load(state); !loaded) return loaded;
  snapshot_ = state;
  step_ = state.step;
  divergence_.reset();
  due_ = 0.0;
  ++picture_number_;
  return {};
}

Status Simulation::change(const Scene& scene, bool keep_state) {
  if (const Status settled = settle(); !settled) return settled;
  auto built = build_model(scene.model);
  if (!built) return built.error();
  auto model = std::make_unique<Model>(std::move(*built));
  auto made = make_solver(*model, backend());
  if (!made) return made.error();
  const bool fits = keep_state && check_sizes(*model, snapshot_).ok();
  State state = fits ? snapshot_ : initial_state(*model, Precision::single);
  if (fits && model->simulation.timestep != model_->simulation.timestep) {
    // Time goes on from where it was, in steps of the new length.
    const double t = time() / model->simulation.timestep;
    if (t < 0x1p62) state.step = static_cast<std::uint64_t>(std::llround(t));
  }
  const bool other_step = model->simulation.timestep != model_->simulation.timestep;
  install(std::move(*made));
  model_ = std::move(model);
  ++model_number_;
  if (!fits) forget_history();
  if (other_step) past_.clear();  // their times counted steps of the old length
  return load(state);
}

Status Simulation::set_backend(BackendName name) {
  if (name == backend()) return {};
  if (const Status settled = settle(); !settled) return settled;
  auto made = make_solver(*model_, name);
  if (!made) return made.error();
  const auto divergence = divergence_;
  install(std::move(*made));
  const Status loaded = load(State(snapshot_));
  divergence_ = divergence;
  return loaded;
}

Status Simulation::reset() {
  worker_.finish();
  has_outcome_ = false;
  forget_history();
  const State start = initial_state(*model_, Precision::single);
  if (const Status loaded = load(start); !loaded) return loaded;
  add_sample(start, measure(*model_, start));
  return {};
}

void Simulation::forget_history() {
  past_.clear();
  energies_.clear();
  last_remembered_ = {};
  rate_steps_ = 0;
  steps_per_second_ = 0.0;
}

void Simulation::set_running(bool running) {
  running_ = running && !divergence_;
  due_ = 0.0;
  behind_ = false;
  rate_start_ = Clock::now();
  rate_steps_ = 0;
  if (!running_) steps_per_second_ = 0.0;
}

Status Simulation::single_step() {
  if (running_ || divergence_) return {};
  if (const Status settled = settle(); !settled) return settled;
  const auto advanced = solver_->advance(1);
  if (!advanced) return advanced.error();
  note(*advanced ? 0 : 1, *advanced);
  if (const Status read = refresh_snapshot(); !read) return read;
  add_sample(snapshot_, measure(*model_, snapshot_));
  return {};
}

void Simulation::note(std::uint64_t steps, const std::optional<Divergence>& divergence) {
  step_ += steps;
  rate_steps_ += steps;
  due_ = std::max(due_ - static_cast<double>(steps), 0.0);
  if (steps > 0) ++picture_number_;
  if (divergence) {
    set_running(false);
    divergence_ = divergence;
  }
}

Status Simulation::update(double dt, double budget) {
  if (!worker_.busy()) {
    if (const Status taken = take_outcome(); !taken) return taken;
  }
  if (!running_) {
    // What is told of a pause is what is seen.
    return gpu_ && snapshot_.step != step_ ? refresh_snapshot() : Status();
  }
  const SimulationSettings& s = model_->simulation;
  const double asked = pace == Pace::real_time ? speed * dt / s.timestep : speed * s.steps_per_frame;
  due_ += asked;
  // What was not done within two pictures is never made good: the factor tells, the motion does not jump.
  const double most = std::max(2.0 * asked, 1.0);
  behind_ = due_ > most;
  due_ = std::min(due_, most);
  if (const double window = seconds_since(rate_start_); window > rate_window) {
    steps_per_second_ = static_cast<double>(rate_steps_) / window;
    rate_start_ = Clock::now();
    rate_steps_ = 0;
  }
  const auto steps = static_cast<std::uint64_t>(due_);
  if (steps == 0) return {};
  if (gpu_) return advance_gpu(steps, budget);
  if (!worker_.busy()) start_job(steps, std::max(budget, shortest_job));
  return {};
}

Status Simulation::advance_gpu(std::uint64_t steps, double budget) {
  const auto start = Clock::now();
  std::uint64_t done = 0;
  while (done < steps && !divergence_) {
    const std::uint64_t count = std::min(batch_, steps - done);
    const auto before = Clock::now();
    const auto advanced = solver_->advance(count);
    if (!advanced) return advanced.error();
    std::uint64_t good = count;
    if (*advanced) good = (*advanced)->step - 1 - step_;
    note(good, *advanced);
    done += count;
    const double took = seconds_since(before);
    // A batch is about a quarter of the budget, so that its end is not far beyond.
    if (count == batch_ && took < 0.125 * budget) batch_ = std::min<std::uint64_t>(2 * batch_, 256);
    if (took > 0.5 * budget) batch_ = std::max<std::uint64_t>(batch_ / 2, 1);
    if (seconds_since(start) > 0.75 * budget) break;
  }
  if (divergence_ || Clock::now() - last_sampled_ > sample_every) {
    if (const Status read = refresh_snapshot(); !read) return read;
    if (!worker_.busy()) start_measuring();
  }
  return {};
}

void Simulation::start_measuring() {
  last_sampled_ = Clock::now();
  has_outcome_ = true;
  outcome_ = Outcome{};
  outcome_.state = snapshot_;
  worker_.start([this](const std::atomic<bool>&) { outcome_.measures = measure(*model_, outcome_.state); });
}

void Simulation::start_job(std::uint64_t steps, double budget) {
  has_outcome_ = true;
  outcome_ = Outcome{};
  worker_.start([this, steps, budget](const std::atomic<bool>& hurry) {
    const auto start = Clock::now();
    while (outcome_.steps < steps && !hurry) {
      const auto advanced = solver_->advance(1);
      if (!advanced) {
        outcome_.error = advanced.error();
        return;
      }
      outcome_.divergence = *advanced;
      if (outcome_.divergence) break;
      ++outcome_.steps;
      if (seconds_since(start) > budget) break;
    }
    auto state = solver_->state();
    if (!state) {
      outcome_.error = state.error();
      return;
    }
    outcome_.state = std::move(*state);
    outcome_.measures = measure(*model_, outcome_.state);
  });
}

Status Simulation::take_outcome() {
  if (!has_outcome_) return {};
  has_outcome_ = false;
  if (outcome_.error) return *outcome_.error;
  if (!gpu_) {
    snapshot_ = outcome_.state;
    note(outcome_.steps, outcome_.divergence);
  }
  add_sample(outcome_.state, outcome_.measures);
  return {};
}

Status Simulation::settle() {
  worker_.finish();
  if (const Status taken = take_outcome(); !taken) return taken;
  return refresh_snapshot();
}

Status Simulation::refresh_snapshot() {
  if (!gpu_ && worker_.busy()) return {};
  auto state = solver_->state();
  if (!state) return state.error();
  snapshot_ = std::move(*state);
  step_ = snapshot_.step;
  return {};
}

void Simulation::remember(const State& state) {
  if (divergence_ || Clock::now() - last_remembered_ < remember_every) return;
  last_remembered_ = Clock::now();
  const std::uint64_t bytes = 2 * sizeof(Vec3) * std::max<std::uint64_t>(state.position.size(), 1);
  const auto most = std::clamp<std::uint64_t>(most_remembered_bytes / bytes, 1, most_remembered);
  while (past_.size() >= most) past_.pop_front();
  past_.push_back(state);
}

void Simulation::add_sample(const State& state, const Measures& measures) {
  remember(state);
  const double t = static_cast<double>(state.step) * model_->simulation.timestep;
  if (!energies_.empty() && t < energies_.back().time) {
    while (!energies_.empty() && energies_.back().time >= t) energies_.pop_back();
  }
  if (!energies_.empty() && energies_.back().time == t) energies_.pop_back();
  energies_.push_back({t, measures});
  if (energies_.size() <= most_samples) return;
  // Half as dense: the whole run stays in the plot.
  std::deque<EnergySample> thinner;
  for (std::size_t i = 0; i < energies_.size(); i += 2) thinner.push_back(energies_[i]);
  energies_ = std::move(thinner);
}

double Simulation::step_back_time() const {
  return static_cast<double>(past_.back().step) * model_->simulation.timestep;
}

Status Simulation::step_back() {
  if (past_.empty()) return {};
  if (const Status settled = settle(); !settled) return settled;
  set_running(false);
  const State state = std::move(past_.back());
  past_.pop_back();
  last_remembered_ = Clock::now();
  if (const Status loaded = load(state); !loaded) return loaded;
  add_sample(state, measure(*model_, state));
  return {};
}

std::optional<double> Simulation::spring_evaluations_per_second() const {
  if (!staged_method(model_->simulation.integrator)) return std::nullopt;
  return steps_per_second_ * static_cast<double>(model_->springs.size()) *
         force_evaluations_per_step(model_->simulation.integrator);
}

}  // namespace aspic::app
