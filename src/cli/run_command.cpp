#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "aspic/scene.h"
#include "aspic/version.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/headless_run.h"
#include "cli/json.h"
#include "cli/run_summary.h"
#include "io/checkpoint.h"
#include "io/program.h"
#include "model/inputs.h"
#include "model/springs.h"
#include "run/recorder.h"
#include "run/run_files.h"

namespace aspic::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// Scene and start of a run.
struct Start {
  Scene scene;
  std::string scene_toml;      ///< for files that hold it; empty where there are none
  std::optional<State> state;  ///< absent: the scene's own
  std::string inputs_toml;     ///< of a checkpoint
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

/// Whether a file holds the scene.
bool asks_for_scene(const RunOptions& options) {
  return std::ranges::any_of(options.outputs, [](const StateOutput& output) {
    return (output.option == "checkpoint" || output.option == "export") && !output.path.empty();
  });
}

Result<Start> load_start(const RunOptions& options) {
  Start start;
  if (options.resume_file.empty()) {
    ASPIC_TRY(auto scene, load_scene(options.scene, options.overrides, by_set));
    if (asks_for_scene(options)) start.scene_toml = to_toml(scene);
    // A view changes no checkpoint: it is no part of the run.
    ASPIC_TRY(start.scene, with_view(std::move(scene), options.view, by_view));
    return start;
  }
  ASPIC_TRY(auto checkpoint, read_checkpoint(options.resume_file));
  auto scene = parse_scene(checkpoint.scene, options.resume_file);
  if (!scene) {
    return fail(scene.error(), "aspic {} wrote the scene inside the checkpoint, and aspic {} rejects it:\n{}",
                checkpoint.program_version, ASPIC_VERSION, scene.error().what);
  }
  ASPIC_CHECK(check_against_scene(checkpoint, scene->model, options.resume_file));
  if (!options.scene.empty()) {
    ASPIC_TRY(const auto given, load_scene(options.scene, options.overrides, by_set));
    const std::string text = to_toml(given);
    if (text != checkpoint.scene) {
      return fail(ErrorCode::scene_rejected,
                  "{} belongs to a different scene than {}. They first differ at\n{}\nOmit SCENE and --set "
                  "to continue the checkpoint's scene, or omit --resume to start the changed scene.",
                  options.resume_file, options.scene, first_difference(checkpoint.scene, text));
    }
  }
  if (options.precision_given && options.backend.precision != checkpoint.state.precision) {
    return fail(ErrorCode::usage, "{} has a state in {} precision: omit --precision to resume it.",
                options.resume_file, name_of(checkpoint.state.precision));
  }
  ASPIC_TRY(start.scene, with_view(std::move(*scene), options.view, by_view));
  start.scene_toml = std::move(checkpoint.scene);
  start.inputs_toml = std::move(checkpoint.inputs);
  start.state = std::move(checkpoint.state);
  return start;
}

/// The inputs of the run: those of the file, which agree with those that a checkpoint's run had so far.
Result<InputLog> inputs_of_run(const RunOptions& options, const Start& start, const Model& model) {
  const LoggedRun run = {start.scene.model, model};
  InputLog kept;
  if (!start.inputs_toml.empty()) {
    ASPIC_TRY(kept, parse_inputs(start.inputs_toml, options.resume_file, run));
  }
  if (options.replay_file.empty()) return kept;
  ASPIC_TRY(auto given, read_inputs(options.replay_file, run));
  if (!start.state) return given;
  InputLog before = given;
  before.forget_from(start.state->step);
  kept.forget_from(start.state->step);
  if (before == kept) return given;
  return fail(ErrorCode::scene_rejected,
              "{} has other inputs before step {}, where {} continues, than the run had so far. Omit "
              "--resume to replay from the start, or omit --replay to continue with the checkpoint's inputs.",
              printable_line(options.replay_file), start.state->step, printable_line(options.resume_file));
}

/// `recorder` is null where no images are wanted. A run that loses its images continues if it writes
/// anything else.
Result<Outcome> simulate(HeadlessRun& headless, Recorder* recorder, std::uint64_t last_step,
                         const InterruptGuard& interrupt) {
  ASPIC_CHECK(headless.begin());
  ProgressBar bar(last_step);
  const auto started = Clock::now();
  Losses losses;
  const auto take_image = [&]() -> Status {
    if (!recorder) return {};
    const Status drawn = recorder->reach(headless.solver(), headless.step());
    ASPIC_CHECK(losses.after_image(*recorder, drawn, headless.files().any_left()));
    if (!losses.rendered()) recorder = nullptr;
    return {};
  };
  ASPIC_CHECK(take_image());
  while (headless.step() < last_step && !headless.stopped()) {
    const double before = headless.seconds();
    ASPIC_CHECK(headless.advance_to(recorder ? std::min(recorder->next_step(), last_step) : last_step,
                                    interrupt, [&](std::uint64_t step) { bar.update(step); }));
    if (!recorder || headless.stopped()) continue;
    recorder->add_simulation(headless.seconds() - before);
    ASPIC_CHECK(take_image());
  }
  ASPIC_TRY(auto outcome, headless.outcome(last_step));
  outcome.rendered = losses.rendered();
  outcome.wall_seconds = std::chrono::duration<double>(Clock::now() - started).count();
  return outcome;
}

/// The last images, after all other files: an encoder may keep a run waiting.
void finish_images(Recorder& recorder, Solver& solver, Outcome& outcome) {
  if (!outcome.rendered) return;
  const auto started = Clock::now();
  outcome.rendered = recorder.finish(solver, outcome.state.step);
  outcome.wall_seconds += std::chrono::duration<double>(Clock::now() - started).count();
}

Status print_summary(const RunOptions& options, const RunReport& run, const std::vector<std::string>& files,
                     const Recorder* recorder) {
  if (options.json) {
    Json json = to_json(run);
    json["images"] = recorder ? to_json(recorder->times(), recorder->device()) : Json();
    json["files"] = files;
    return print_data(to_text(json));
  }
  std::string text = to_text(run);
  for (const std::string& file : files) text += fmt::format("wrote        {}\n", file);
  return print_text(text);
}

}  // namespace

Status execute(const RunOptions& options) {
  if (!options.differences.empty()) return execute_comparison(options);
  const InterruptGuard interrupt;
  ASPIC_TRY(auto start, load_start(options));
  ASPIC_TRY(const auto steps, steps_of(options.length, start.scene.model.simulation));
  if (start.state && start.state->step > steps) {
    return fail(ErrorCode::usage,
                "{} is already at step {}, but the run ends at step {}. Raise --steps or --duration, which "
                "count from the scene's start.",
                options.resume_file, start.state->step, steps);
  }
  const std::uint64_t first_step = start.state ? start.state->step : 0;
  ASPIC_CHECK(check_frame_count(options.images, start.scene.model.simulation.timestep, first_step, steps));
  ASPIC_TRY(auto built, build_model(start.scene.model));
  const SharedModel held_model = shared(std::move(built));
  const Model& model = *held_model;
  ASPIC_TRY(const InputLog inputs, inputs_of_run(options, start, model));
  const RunFacts facts = {start.scene_toml, start.scene.model.simulation.integrator,
                          inputs.empty() ? "" : to_toml(inputs, model.simulation.timestep)};
  BackendChoice choice = options.backend;
  if (start.state) choice.precision = start.state->precision;
  const PageFacts page = {&start.scene,     first_step,       steps, command_of(options.words),
                          choice.precision, choice.arithmetic};
  ASPIC_TRY(auto files, RunFiles::open(options.outputs, options.images, facts,
                                       options.force ? Overwrite::allow : Overwrite::refuse, page));

  ASPIC_TRY(auto backend, make_backend(choice, held_model));
  if (start.state) ASPIC_CHECK(backend.solver->load(*start.state));
  ASPIC_CHECK(check_log(model, inputs, backend.solver->precision()));
  warn_if_unstable(model, interrupt);
  RunWatch watch(start.scene.model, model, first_step == 0, backend.solver->precision());

  start.state.reset();
  std::unique_ptr<Recorder> recorder;
  if (options.images.any()) {
    ASPIC_TRY(recorder, Recorder::create(options.images, start.scene, backend, files.take_frame_sinks(),
                                         first_step, steps));
  }
  HeadlessRun headless(*backend.solver, files, first_step, options.images.any(), inputs);
  headless.set_watch(watch);
  ASPIC_TRY(auto outcome, simulate(headless, recorder.get(), steps, interrupt));
  const std::string warnings = export_text(outcome.diagnostics);
  (void)files.finish({.model = model,
                      .state = outcome.state,
                      .solves = outcome.solves.value_or(SolveStatistics{}),
                      .divergence = outcome.divergence ? &*outcome.divergence : nullptr,
                      .inputs = &backend.solver->inputs(),
                      .warnings = warnings});
  outcome.actuator_work = files.actuator_work();
  if (recorder) finish_images(*recorder, *backend.solver, outcome);
  std::vector<Error> lost = recorder ? recorder->failures() : std::vector<Error>{};
  if (!outcome.rendered && lost.empty()) lost.push_back(outcome.rendered.error());
  lost.insert(lost.end(), files.failures().begin(), files.failures().end());
  std::vector<std::string> written = recorder ? recorder->written() : std::vector<std::string>{};
  written.insert(written.end(), files.written().begin(), files.written().end());
  const Status summary =
      print_summary(options, {start.scene, model, backend, outcome, inputs}, written, recorder.get());
  if (recorder) print_frame_times(recorder->times(), recorder->device());
  if (!lost.empty() && outcome.divergence)
    print_message(worded(divergence_error(model, outcome, interrupt), FrontEnd::command_line));
  ASPIC_CHECK(lost_error(lost, !written.empty()));
  if (!summary) return summary;
  if (outcome.divergence) return divergence_error(model, outcome, interrupt);
  if (outcome.interrupted) {
    const auto checkpoint = std::ranges::find(options.outputs, "checkpoint", &StateOutput::option);
    return fail(ErrorCode::interrupted, "interrupted at step {} of {}; all files are complete.{}",
                outcome.state.step, steps,
                checkpoint == options.outputs.end() || checkpoint->path.empty()
                    ? ""
                    : fmt::format(" Resume with aspic run --resume {}.", checkpoint->path));
  }
  return {};
}

}  // namespace aspic::cli
