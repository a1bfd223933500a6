#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "analysis/energy.h"
#include "analysis/stability.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/checkpoint.h"
#include "io/program.h"
#include "model/springs.h"
#include "run/recorder.h"
#include "run/run_files.h"
#include "scene/load.h"
#include "scene/write.h"

namespace aspic::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// Scene and start of a run.
struct Start {
  Scene scene;
  std::string scene_toml;      ///< for a checkpoint; empty where none is asked for
  std::optional<State> state;  ///< absent: the scene's own
};

/// Where two scene texts part, for a message.
std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream in_a(a), in_b(b);
  std::string line_a, line_b;
  for (;;) {
    const bool more_a = static_cast<bool>(std::getline(in_a, line_a)),
               more_b = static_cast<bool>(std::getline(in_b, line_b));
    if (!more_a) line_a = "(end)";
    if (!more_b) line_b = "(end)";
    if (line_a != line_b || !more_a) return fmt::format("  checkpoint: {}\n  given:      {}", line_a, line_b);
  }
}

/// --view as --set sees it. A view changes no checkpoint: it is no part of the run.
std::vector<std::string> overrides_of(const std::vector<std::string>& view) {
  std::vector<std::string> overrides;
  for (const std::string& argument : view) overrides.push_back("view." + argument);
  return overrides;
}

bool asks_for_checkpoint(const RunOptions& options) {
  return std::ranges::any_of(options.outputs, [](const StateOutput& output) {
    return output.option == "checkpoint" && !output.path.empty();
  });
}

Result<Start> load_start(const RunOptions& options) {
  Start start;
  if (options.resume_file.empty()) {
    ASPIC_TRY(auto scene, load_scene(options.scene, options.overrides));
    if (asks_for_checkpoint(options)) start.scene_toml = to_toml(scene);
    if (!options.view.empty()) {
      ASPIC_TRY(scene, with_overrides(std::move(scene), overrides_of(options.view)));
    }
    start.scene = std::move(scene);
    return start;
  }
  ASPIC_TRY(auto checkpoint, read_checkpoint(options.resume_file));
  auto scene = parse_scene(checkpoint.scene, options.resume_file, overrides_of(options.view));
  if (!scene) {
    return fail(scene.error().code,
                "the scene inside the checkpoint, written by aspic {}, is not accepted by aspic {}:\n{}",
                checkpoint.program_version, ASPIC_VERSION, scene.error().message);
  }
  ASPIC_CHECK(check_against_scene(checkpoint, scene->model, options.resume_file));
  if (!options.scene.empty()) {
    ASPIC_TRY(const auto given, load_scene(options.scene, options.overrides));
    const std::string text = to_toml(given);
    if (text != checkpoint.scene) {
      return fail(ErrorCode::scene_rejected,
                  "{} belongs to a different scene than {}. They first differ at\n{}\nOmit SCENE and --set "
                  "to continue the checkpoint's scene, or omit --resume to start the changed scene.",
                  options.resume_file, options.scene, first_difference(checkpoint.scene, text));
    }
  }
  if (options.precision_given && options.backend.precision != checkpoint.state.precision) {
    return fail(ErrorCode::usage, "{} was written in {} precision: resume it without --precision.",
                options.resume_file, name_of(checkpoint.state.precision));
  }
  start.scene = std::move(*scene);
  start.scene_toml = std::move(checkpoint.scene);
  start.state = std::move(checkpoint.state);
  return start;
}

/// What became of a run.
struct Outcome {
  State state;
  std::uint64_t first_step = 0, last_step = 0;  ///< of this run; last: as planned
  std::optional<Divergence> divergence;
  std::optional<SolveStatistics> solves;  ///< implicit Euler only
  Status pictured;                        ///< whether the pictures were completed
  bool interrupted = false;
  double wall_seconds = 0.0;
  double steps_per_second() const {
    return wall_seconds > 0.0 ? static_cast<double>(state.step - first_step) / wall_seconds : 0.0;
  }
};

Json to_json(const SolveStatistics& s) {
  return {{"converged", s.converged},         {"stagnated", s.stagnated},
          {"not_converged", s.not_converged}, {"newton_iterations", s.newton_iterations},
          {"cg_iterations", s.cg_iterations}, {"worst_residual", s.worst_residual}};
}

/// Steps between polls for Ctrl-C and redraws: as many as take about a twentieth of a second.
class BatchSize {
 public:
  std::uint64_t next() const { return size_; }
  void took(std::uint64_t steps, double seconds) {
    if (steps < size_) return;
    if (seconds < 0.025) size_ = std::min<std::uint64_t>(2 * size_, 1u << 20);
    if (seconds > 0.1) size_ = std::max<std::uint64_t>(size_ / 2, 1);
  }

 private:
  std::uint64_t size_ = 1;
};

/// `recorder` is null where no pictures are wanted.
Result<Outcome> simulate(Solver& solver, RunFiles& files, Recorder* recorder, std::uint64_t first_step,
                         std::uint64_t last_step, const InterruptGuard& interrupt) {
  const Model& model = solver.model();
  Outcome outcome;
  outcome.first_step = first_step;
  outcome.last_step = last_step;
  // A State takes as much memory as all of a solver's: one is held where it is looked at, and none while
  // steps are made.
  const auto sample = [&]() -> Status {
    ASPIC_TRY(const auto state, solver.state());
    return files.take({model, state, solver.solve_statistics().value_or(SolveStatistics{})});
  };
  ASPIC_CHECK(sample());

  ProgressBar bar(last_step);
  BatchSize batch;
  std::uint64_t step = first_step;
  const auto started = Clock::now();
  if (recorder) ASPIC_CHECK(recorder->reach(solver, step));
  while (step < last_step && !outcome.divergence && !(outcome.interrupted = interrupt.interrupted())) {
    std::uint64_t count = std::min(batch.next(), last_step - step);
    const std::uint64_t wanted = files.next_step(step);
    count = std::min(count, wanted - step);
    if (recorder) count = std::min(count, recorder->next_step() - step);
    const auto before = Clock::now();
    ASPIC_TRY(outcome.divergence, solver.advance(count));
    if (outcome.divergence) break;
    step += count;
    if (step == wanted) ASPIC_CHECK(sample());
    if (recorder) {
      recorder->add_simulation(std::chrono::duration<double>(Clock::now() - before).count());
      ASPIC_CHECK(recorder->reach(solver, step));
    }
    batch.took(count, std::chrono::duration<double>(Clock::now() - before).count());
    bar.update(step);
  }
  ASPIC_TRY(auto state, solver.state());  // waits for the device: the time below is that of finished work
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - started).count(); };
  outcome.wall_seconds = seconds();
  if (const auto bad = first_not_finite(measure(model, state))) {
    return fail(ErrorCode::diverged, "{} of step {} is not a finite number; the outputs were not completed.",
                *bad, state.step);
  }
  if (recorder) {
    outcome.pictured = recorder->finish(solver, state.step);
    outcome.wall_seconds = seconds();
  }
  outcome.state = std::move(state);
  outcome.solves = solver.solve_statistics();
  return outcome;
}

Json to_json(const Divergence& d, double timestep) {
  Json json = {{"step", d.step}, {"time", static_cast<double>(d.step) * timestep}};
  if (d.residual) {
    json["residual"] = true;
  } else {
    json[d.ball ? "ball" : "particle"] = d.particle;
  }
  json["finite"] = d.finite;
  return json;
}

Json to_json(const Recorder& recorder) {
  const FrameTimes t = recorder.times();
  return {{"count", t.frames},
          {"device", recorder.device()},
          {"seconds_per_frame",
           {{"simulate", t.per_frame(t.simulate)},
            {"draw", t.per_frame(t.draw)},
            {"read", t.per_frame(t.read)},
            {"encode", t.per_frame(t.encode)}}}};
}

/// One line on stderr: pictures are by the way, the summary on stdout is the run's.
void print_frame_times(const Recorder& recorder) {
  const FrameTimes t = recorder.times();
  const auto ms = [&](double seconds) { return 1000.0 * t.per_frame(seconds); };
  print_message(fmt::format(
      "{} pictures on {}; per picture: simulate {:.1f} ms, draw {:.1f} ms, read {:.1f} ms, encode {:.1f} ms.",
      t.frames, recorder.device(), ms(t.simulate), ms(t.draw), ms(t.read), ms(t.encode)));
}

Status print_summary(const RunOptions& options, const Scene& scene, const Model& model,
                     const Backend& backend, const Outcome& outcome, const std::vector<std::string>& files,
                     const Recorder* recorder) {
  const State& state = outcome.state;
  const Measures m = measure(model, state);
  const double time = static_cast<double>(state.step) * model.simulation.timestep;
  const std::string hash = state_hash_text(state);
  if (options.json) {
    // Not within the list: g++ 12 destroys what it has not made yet when memory runs out in a list with `?:`.
    const Json diverged =
        outcome.divergence ? to_json(*outcome.divergence, model.simulation.timestep) : Json();
    const Json solves = outcome.solves ? to_json(*outcome.solves) : Json();
    const Json pictures = recorder ? to_json(*recorder) : Json();
    return print_data(to_text({
        {"scene", scene.name},
        {"backend", backend.row->name},
        {"backend_reason", or_null(backend.reason)},
        {"device", backend.device},
        {"precision", name_of(state.precision)},
        {"force_path", or_null(backend.force_path)},
        {"arithmetic", name_of(backend.arithmetic)},
        {"integrator", name_of(model.simulation.integrator)},
        {"timestep", model.simulation.timestep},
        {"particles", model.particle_count()},
        {"springs", spring_count(model)},
        {"balls", model.ball_count()},
        {"first_step", outcome.first_step},
        {"steps", state.step},
        {"time", time},
        {"wall_seconds", outcome.wall_seconds},
        {"steps_per_second", outcome.steps_per_second()},
        {"state_hash", hash},
        {"diverged", diverged},
        {"interrupted", outcome.interrupted},
        {"implicit_solves", solves},
        {"energies", Json{{"kinetic", m.kinetic},
                          {"elastic", m.elastic},
                          {"gravitational", m.gravitational},
                          {"total", m.total()}}},
        {"momentum", Json{m.momentum.x, m.momentum.y, m.momentum.z}},
        {"max_speed", m.max_speed},
        {"min_height", m.min_height},
        {"pictures", pictures},
        {"files", files},
    }));
  }
  std::string text = fmt::format("scene        {} ({} particles, {} springs{})\n", scene.name,
                                 model.particle_count(), spring_count(model),
                                 model.ball_count() > 0 ? fmt::format(", {} balls", model.ball_count()) : "");
  text += fmt::format("backend      {}{}, {} precision{}\n", backend.row->name,
                      backend.force_path.empty() ? "" : ", force path " + backend.force_path,
                      name_of(state.precision),
                      backend.reason.empty() ? "" : fmt::format(" (auto: {})", backend.reason));
  text += fmt::format("device       {}\n", backend.device);
  text += fmt::format("integrator   {}, time step {} s\n", name_of(model.simulation.integrator),
                      model.simulation.timestep);
  text += fmt::format("reached      step {} of {}, t = {:.6g} s\n", state.step, outcome.last_step, time);
  text += fmt::format("took         {:.3g} s, {:.4g} steps/s\n", outcome.wall_seconds,
                      outcome.steps_per_second());
  text +=
      fmt::format("energy       kinetic {:.6g} J, elastic {:.6g} J, gravitational {:.6g} J, total {:.6g} J\n",
                  m.kinetic, m.elastic, m.gravitational, m.total());
  text += fmt::format("extremes     fastest {:.6g} m/s, lowest y = {:.6g} m\n", m.max_speed, m.min_height);
  if (outcome.solves) {
    const SolveStatistics& s = *outcome.solves;
    text += fmt::format(
        "solves       {} converged, {} stagnated, {} not converged; worst residual {:.3g} m/s; {} Newton and "
        "{} conjugate gradient iterations\n",
        s.converged, s.stagnated, s.not_converged, s.worst_residual, s.newton_iterations, s.cg_iterations);
  }
  text += fmt::format("state hash   {}\n", hash);
  for (const std::string& file : files) text += fmt::format("wrote        {}\n", file);
  return print_text(text);
}

/// The infinite lattice clears most cubes at once; a large one's own spectrum takes seconds.
void warn_if_unstable(const Model& model, const InterruptGuard& interrupt) {
  const SimulationSettings& simulation = model.simulation;
  if (certainly_stable(model, simulation.integrator, simulation.timestep)) return;
  const StabilityLimit stable = stability_limit(model, simulation.integrator, StabilityEffort::quick,
                                                [&](double) { return !interrupt.interrupted(); });
  if (!interrupt.interrupted() && exceeds(simulation.timestep, stable))
    print_warning(unstable_sentence(simulation.timestep, simulation.integrator, stable));
}

Error divergence_error(const Model& model, const Outcome& outcome, const InterruptGuard& interrupt) {
  const Divergence& d = *outcome.divergence;
  const StabilityLimit stable = stability_limit(model, model.simulation.integrator, StabilityEffort::quick,
                                                [&](double) { return !interrupt.interrupted(); });
  const double h = model.simulation.timestep;
  return fail(ErrorCode::diverged,
              "the simulation diverged in step {} (t = {:.6g} s): {} {}. The time step is {} s; {}. The last "
              "good step is {}; every output holds that state.",
              d.step, static_cast<double>(d.step) * h, body_text(d), fault_text(d), h,
              stability_sentence(model.simulation.integrator, stable), outcome.state.step);
}

}  // namespace

Status execute(const RunOptions& options) {
  const InterruptGuard interrupt;
  ASPIC_TRY(auto start, load_start(options));
  ASPIC_TRY(const auto steps, steps_of(options.length, start.scene.model.simulation));
  if (start.state && start.state->step > steps) {
    return fail(ErrorCode::usage,
                "{} is already at step {}, but the run is to end at step {}; --steps and --duration count "
                "from the scene's start.",
                options.resume_file, start.state->step, steps);
  }
  const RunFacts facts = {start.scene_toml, start.scene.model.simulation.integrator};
  ASPIC_TRY(auto files, RunFiles::open(options.outputs, options.pictures, facts,
                                       options.force ? Overwrite::allow : Overwrite::refuse));
  ASPIC_TRY(const auto model, build_model(start.scene.model));

  BackendChoice choice = options.backend;
  if (start.state) choice.precision = start.state->precision;
  ASPIC_TRY(auto backend, make_backend(choice, model));
  if (start.state) ASPIC_CHECK(backend.solver->load(*start.state));
  warn_if_unstable(model, interrupt);

  const std::uint64_t first_step = start.state ? start.state->step : 0;
  start.state.reset();
  std::unique_ptr<Recorder> recorder;
  if (options.pictures.any()) {
    ASPIC_TRY(recorder, Recorder::create(options.pictures, start.scene, backend, files.take_frame_sinks(),
                                         first_step, steps));
  }
  ASPIC_TRY(auto outcome, simulate(*backend.solver, files, recorder.get(), first_step, steps, interrupt));
  const Status finished = files.finish({model, outcome.state, outcome.solves.value_or(SolveStatistics{})});
  std::vector<std::string> written = recorder ? recorder->written() : std::vector<std::string>{};
  written.insert(written.end(), files.written().begin(), files.written().end());
  const Status summary =
      print_summary(options, start.scene, model, backend, outcome, written, recorder.get());
  if (recorder) print_frame_times(*recorder);
  if (!outcome.pictured) return outcome.pictured;
  if (!finished) return finished;
  if (!summary) return summary;
  if (outcome.divergence) return divergence_error(model, outcome, interrupt);
  if (outcome.interrupted) {
    const auto checkpoint = std::ranges::find(options.outputs, "checkpoint", &StateOutput::option);
    return fail(ErrorCode::interrupted, "interrupted at step {} of {}; all files were completed.{}",
                outcome.state.step, steps,
                checkpoint == options.outputs.end() || checkpoint->path.empty()
                    ? ""
                    : fmt::format(" Resume with aspic run --resume {}.", checkpoint->path));
  }
  return {};
}

}  // namespace aspic::cli
