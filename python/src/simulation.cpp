#include "simulation.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace aspic::python {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// With the GIL. Whether what a signal's handler does is no exception.
void look_for_signals() {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

}  // namespace

BackendChoice choice_of(const std::string& words, std::optional<bool> doubles, unsigned threads) {
  BackendChoice asked;
  if (doubles) asked.precision = *doubles ? Precision::double_ : Precision::single;
  asked.threads = threads;
  BackendChoice choice = take(parse_backend(words, asked));
  // What its words leave open is as asked only where the backend has it: nobody should get less unawares.
  if (choice.row != nullptr && doubles) choice.precision = asked.precision;
  if (choice.row != nullptr && threads > 0) choice.threads = threads;
  return choice;
}

void Chunk::took(std::uint64_t steps, double seconds) {
  if (steps < size_) return;
  if (seconds < 0.025) size_ = std::min<std::uint64_t>(2 * size_, 1u << 20);
  if (seconds > 0.1) size_ = std::max<std::uint64_t>(size_ / 2, 1);
}

Simulation::Simulation(Scene scene, const std::string& backend, std::optional<bool> doubles, unsigned threads)
    : scene_(std::move(scene)) {
  bool stopped = false;
  {
    const Unlocked others;
    start(choice_of(backend, doubles, threads), stopped);
  }
  if (stopped) throw nb::python_error();
}

/// A signal leaves the rest undone.
void Simulation::start(const BackendChoice& choice, bool& stopped) {
  model_ = take(make_model(scene_.model));
  backend_ = take(make_backend(choice, model_));
  backend_.solver->set_stop_flag(&stop_);
  watch_.emplace(scene_.model, *model_, true, backend_.solver->precision());
  keep(watch_->at_start());
  std::string unstable = unstable_step_warning(*model_, [&](double) { return !(stopped = signalled()); });
  if (!unstable.empty()) warnings_.emplace_back("step", "", step_, std::move(unstable));
}

void Simulation::refuse_while_viewed() const {
  if (views_ > 0)
    throw nb::buffer_error(
        "arrays of peek() show the state in the solver's memory: delete them, or use copies, before the "
        "simulation changes");
}

Scene Simulation::scene() {
  return alone([&] { return scene_; });
}

SharedModel Simulation::model() {
  return alone([&] { return model_; });
}

std::uint64_t Simulation::step() {
  return alone([&] { return step_; });
}

State Simulation::state() {
  return alone([&] { return take(backend_.solver->state()); });
}

std::uint64_t Simulation::read_into(const StateView& view) {
  return alone([&] { return take(backend_.solver->read_into(view)); });
}

void Simulation::read_alone(State& into) {
  Solver& solver = *backend_.solver;
  if (into.position.empty() && into.ball_position.empty())
    into = take(solver.state());
  else
    into.step = take(solver.read_into(view_of(into)));
}

const State& Simulation::state_alone() {
  read_alone(state_);
  return state_;
}

Measures Simulation::measures() {
  return alone([&] {
    if (!meter_) meter_.emplace(*model_);
    return meter_->measure(state_alone(), backend_.solver->inputs());
  });
}

Measures Simulation::motion() {
  return alone([&] { return measure_motion(*model_, state_alone()); });
}

std::optional<double> Simulation::add_work(ActuatorWork& work) {
  return alone([&] { return work.add(*model_, state_alone(), backend_.solver->inputs()); });
}

StateQuantities Simulation::quantities() {
  return alone([&] { return quantities_of(*model_, state_alone(), backend_.solver->inputs()); });
}

void Simulation::load(const State& state, const InputLog* log) {
  alone([&] {
    refuse_while_viewed();
    check(backend_.solver->load(state));
    step_ = state.step;
    state_set_ = true;
    if (log != nullptr) log_ = *log;
    check(backend_.solver->set_inputs(log_.at(step_)));
  });
}

Advance Simulation::advance_alone(std::uint64_t steps) {
  refuse_while_viewed();
  const Advance made = take(aspic::advance(*backend_.solver, log_, step_, steps));
  step_ += made.steps;
  return made;
}

/// Warns once when solves miss the tolerance.
void Simulation::look_at_solves() {
  if (solves_told_) return;
  const auto solves = backend_.solver->solve_statistics();
  if (!solves || solves->not_converged == 0) return;
  solves_told_ = true;
  warnings_.emplace_back("solve", "", step_,
                         std::to_string(solves->not_converged) + " of " + std::to_string(solves->steps) +
                             " steps of implicit Euler did not converge, up to step " +
                             std::to_string(step_) +
                             ": raise implicit.newton-iterations or lower simulation.timestep; "
                             "Simulation.solves has the residuals");
}

/// Without turn and with the GIL: raises what ended steps early.
void Simulation::check_stopped(bool stopped) const {
  if (!stopped) return;
  if (stop_) throw stopped_error();
  throw nb::python_error();
}

void Simulation::look_alone(std::uint64_t before) {
  if (step_ < watch_->next_step(before)) return;
  keep(watch_->look(*model_, state_alone(), log_, std::exchange(state_set_, false)));
}

void Simulation::keep(const std::vector<Diagnostic>& found) {
  for (const Diagnostic& each : found)
    warnings_.emplace_back(each.id, each.where, each.step, each.sentence());
}

std::optional<SolveStatistics> Simulation::solves() {
  return alone([&] { return backend_.solver->solve_statistics(); });
}

std::vector<Simulation::Warning> Simulation::warnings() {
  return alone([&] { return warnings_; });
}

std::vector<Simulation::Warning> Simulation::new_warnings() {
  return alone([&] {
    const auto first =
        warnings_.begin() + static_cast<std::ptrdiff_t>(std::exchange(told_, warnings_.size()));
    return std::vector<Warning>(first, warnings_.end());
  });
}

Advance Simulation::advance(std::uint64_t steps) {
  stop_ = false;
  Advance all;
  Chunk chunk;
  while (all.steps < steps && !all.divergence && !all.stopped) {
    const auto begin = Clock::now();
    Advance part = alone([&] {
      const std::uint64_t before = step_;
      Advance made = advance_alone(std::min({chunk.size(), steps - all.steps, steps_to_look()}));
      look_alone(before);
      look_at_solves();
      return made;
    });
    part.steps += all.steps;
    chunk.took(part.steps - all.steps, seconds_since(begin));
    all = part;
    // A gpu solver does not heed the flag.
    all.stopped = all.stopped || (stop_ && all.steps < steps && !all.divergence);
    look_for_signals();
  }
  return all;
}

std::optional<std::uint64_t> Simulation::compare(Simulation& other, std::uint64_t steps) {
  auto looked = Clock::now();
  State states[2];
  for (std::uint64_t i = 0; i < steps; ++i) {
    bool diverged = false;
    std::uint64_t step = 0;
    Simulation* const both[2] = {this, &other};
    for (std::size_t s = 0; s < 2; ++s) {
      both[s]->alone([&] {
        diverged = both[s]->advance_alone(1).divergence.has_value() || diverged;
        both[s]->read_alone(states[s]);
        step = std::max(step, states[s].step);
      });
    }
    if (states[0].step != states[1].step || !take(compare_states(states[0], states[1])).identical())
      return step;
    if (diverged) return std::nullopt;
    if (seconds_since(looked) < 0.05) continue;
    look_for_signals();
    looked = Clock::now();
  }
  return std::nullopt;
}

template <class Next, class Visit>
Result<std::optional<Divergence>> Simulation::advance_visiting(std::uint64_t last, const Next& next_step,
                                                               const Visit& visit, bool& stopped) {
  std::optional<Divergence> divergence;
  Chunk chunk;
  while (true) {
    if (const Status visited = visit(); !visited) return visited.error();
    if (step_ == last || divergence || stopped) return divergence;
    const std::uint64_t count = std::min({next_step() - step_, last - step_, chunk.size(), steps_to_look()});
    const std::uint64_t before = step_;
    const auto begin = Clock::now();
    const Advance made = advance_alone(count);
    divergence = made.divergence;
    look_alone(before);
    look_at_solves();
    chunk.took(count, seconds_since(begin));
    stopped = made.stopped || stop_ || signalled();
  }
}

Result<std::optional<Divergence>> Simulation::video_alone(const VideoWish& wish, bool& stopped) {
  ImageOutput output;
  const std::filesystem::path path(wish.path);
  (path.has_extension() ? output.video : output.frames) = wish.path;
  output.size = wish.size;
  output.fps = wish.fps;
  output.speed = wish.speed;
  output.text = wish.text;
  auto files =
      take(RunFiles::open({}, output, facts_alone(), wish.overwrite ? Overwrite::allow : Overwrite::refuse));
  const std::uint64_t last = step_ + wish.steps;
  const auto recorder =
      take(Recorder::create(output, scene_, backend_, files.take_frame_sinks(), step_, last));
  const auto divergence = take(advance_visiting(
      last, [&] { return recorder->next_step(); }, [&] { return recorder->reach(*backend_.solver, step_); },
      stopped));
  check(recorder->finish(*backend_.solver, step_));
  return divergence;
}

Result<std::optional<Divergence>> Simulation::page_alone(const PageWish& wish, bool& stopped) {
  ImageOutput output;
  (wish.live ? output.page_live : output.page) = wish.path;
  output.fps = wish.fps;
  output.speed = wish.speed;
  const std::uint64_t last = step_ + wish.steps;
  const PageFacts page = {
      &scene_, step_, last, wish.command, backend_.solver->precision(), backend_.arithmetic};
  auto files = take(
      RunFiles::open({}, output, facts_alone(), wish.overwrite ? Overwrite::allow : Overwrite::refuse, page));
  bool begun = false;
  const auto visit = [&]() -> Status {
    if (begun && step_ != last && files.next_step(step_ - 1) != step_) return {};
    begun = true;
    const State& state = state_alone();
    return files.take({.model = *model_, .state = state, .inputs = &backend_.solver->inputs()});
  };
  const auto divergence = take(advance_visiting(
      last, [&] { return files.next_step(step_); }, visit, stopped));
  const State& state = state_alone();
  check(files.finish({.model = *model_,
                      .state = state,
                      .divergence = divergence ? &*divergence : nullptr,
                      .inputs = &backend_.solver->inputs()}));
  return divergence;
}

std::optional<Divergence> Simulation::page(const PageWish& wish) {
  bool stopped = stop_ = false;
  const auto divergence = alone([&] { return take(page_alone(wish, stopped)); });
  check_stopped(stopped);
  return divergence;
}

std::optional<Divergence> Simulation::video(const VideoWish& wish) {
  bool stopped = stop_ = false;
  const auto divergence = alone([&] { return take(video_alone(wish, stopped)); });
  check_stopped(stopped);
  return divergence;
}

std::vector<std::byte> Simulation::image(const std::vector<std::string>& view, const ImageSize& size,
                                         bool text) {
  return alone([&] {
    if (!painter_) painter_ = take(StillPainter::create(scene_, backend_));
    const Scene shown = take(with_view(scene_, view));
    return take(painter_->draw(shown.view, size, text));
  });
}

void Simulation::update(const std::vector<std::string>& overrides) {
  alone([&] {
    refuse_while_viewed();
    Scene changed = take(with_overrides(scene_, overrides));
    changed.model = with_continuous_phases(std::move(changed.model), scene_.model, time_alone());
    const SharedModel model = take(make_model(changed.model));
    check(backend_.solver->set_constants(model));
    painter_.reset();
    meter_.reset();
    // Another time step keeps the time: steps have other numbers.
    step_ = take(backend_.solver->read_into({}));
    log_ = log_.with_timestep(scene_.model.simulation.timestep, changed.model.simulation.timestep);
    scene_ = std::move(changed);
    model_ = model;
    RunWatch watch(scene_.model, *model_, false);
    watch.knows_what(*watch_);
    watch_ = std::move(watch);
  });
}

std::optional<ConstVectors> Simulation::begin_view(std::size_t field) {
  return alone([&]() -> std::optional<ConstVectors> {
    const auto view = backend_.solver->view();
    if (!view) return std::nullopt;
    ++views_;
    return (*view)[field];
  });
}

Inputs Simulation::inputs() {
  return alone([&] { return log_.at(step_); });
}

void Simulation::set_inputs(const Inputs& inputs) {
  alone([&] {
    check(backend_.solver->set_inputs(inputs));
    log_.set(step_, inputs);
  });
}

InputLog Simulation::log() {
  return alone([&] { return log_; });
}

void Simulation::set_log(InputLog log) {
  alone([&] {
    check(backend_.solver->set_inputs(log.at(step_)));
    log_ = std::move(log);
    state_set_ = true;  // by other inputs than these
  });
}

std::string Simulation::log_text() {
  return alone([&] { return to_toml(log_, scene_.model.simulation.timestep); });
}

void Simulation::write_state(const std::string& path, bool overwrite) {
  alone([&] { write_file("state", path, overwrite); });
}

void Simulation::write_checkpoint(const std::string& path, bool overwrite) {
  alone([&] { write_file("checkpoint", path, overwrite); });
}

RunFacts Simulation::facts_alone() const {
  return {to_toml(scene_), scene_.model.simulation.integrator,
          log_.empty() ? "" : to_toml(log_, scene_.model.simulation.timestep)};
}

void Simulation::write_file(const std::string& option, const std::string& path, bool overwrite) {
  auto files = take(RunFiles::open({{option, path, {}}}, {}, facts_alone(),
                                   overwrite ? Overwrite::allow : Overwrite::refuse));
  const State& state = state_alone();
  const Sample sample = {.model = *model_, .state = state, .inputs = &backend_.solver->inputs()};
  check(files.take(sample));
  check(files.finish(sample));
}

}  // namespace aspic::python
