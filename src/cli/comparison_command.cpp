// aspic run --variant: several runs of a scene on one clock.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "aspic/scene.h"
#include "cli/commands.h"
#include "cli/headless_run.h"
#include "cli/json.h"
#include "cli/run_summary.h"
#include "io/program.h"
#include "model/inputs.h"
#include "model/reading.h"
#include "page/page_writer.h"
#include "run/recorder.h"
#include "run/run_files.h"
#include "run/window_host.h"
#include "variants/common_clock.h"
#include "variants/comparison.h"
#include "variants/comparison_recorder.h"

namespace aspic::cli {
namespace {

/// One of several runs, with all that it holds. Not movable: its parts refer to each other.
struct HeadlessVariant {
  HeadlessVariant(Variant variant, SharedModel built, InputLog log, RunFiles opened)
      : run(std::move(variant)), model(std::move(built)), inputs(std::move(log)), files(std::move(opened)) {}
  HeadlessVariant(const HeadlessVariant&) = delete;
  HeadlessVariant& operator=(const HeadlessVariant&) = delete;

  Variant run;
  SharedModel model;
  InputLog inputs;  ///< until its run has them
  RunFiles files;
  std::uint64_t last_step = 0;
  std::string name;  ///< "run 2 (integrator implicit Euler)"
  Backend backend;
  std::optional<RunWatch> watch;
  std::optional<HeadlessRun> headless;
  std::optional<Outcome> outcome;
};
using HeadlessVariants = std::vector<std::unique_ptr<HeadlessVariant>>;

Status refuse_what_needs_one_run(const RunOptions& options) {
  if (!options.resume_file.empty())
    return fail(ErrorCode::usage, "--variant starts every run at the scene's start: omit --resume.");
  if (!options.images.page_live.empty())
    return fail(ErrorCode::usage,
                "a live page has one run: omit --variant, or write --html instead of --html-live.");
  for (const StateOutput& output : options.outputs)
    if (output.path.starts_with("/dev/"))
      return fail(ErrorCode::usage,
                  "--{} {}: with --variant every run writes a separate file; name a file, such as out.csv, "
                  "which becomes out-1.csv, out-2.csv and so on.",
                  output.option, output.path);
  return {};
}

/// The files of a run's states; those of images belong to all runs.
Result<RunFiles> open_files(const RunOptions& options, const Scene& scene, const InputLog& inputs,
                            std::size_t number, Overwrite overwrite) {
  std::vector<StateOutput> outputs = options.outputs;
  for (StateOutput& output : outputs)
    if (!output.path.empty()) output.path = numbered_path(output.path, number);
  const SimulationSettings& simulation = scene.model.simulation;
  const std::string log = inputs.empty() ? "" : to_toml(inputs, simulation.timestep);
  return RunFiles::open(outputs, {}, {to_toml(scene), simulation.integrator, log}, overwrite);
}

Result<HeadlessVariants> make_variants(const RunOptions& options, const std::vector<Difference>& differences,
                                       Overwrite overwrite) {
  ASPIC_TRY(auto scene, load_scene(options.scene, options.overrides, by_set));
  ASPIC_TRY(scene, with_view(std::move(scene), options.view, by_view));
  ASPIC_TRY(const auto steps, steps_of(options.length, scene.model.simulation));
  ASPIC_TRY(auto runs, variants_of(scene, options.backend, differences));
  HeadlessVariants variants;
  InputLog inputs;
  if (!options.replay_file.empty()) {
    ASPIC_TRY(const auto model, build_model(scene.model));
    ASPIC_TRY(inputs, read_inputs(options.replay_file, {scene.model, model}));
  }
  for (Variant& run : runs) {
    const SimulationSettings& simulation = run.scene.model.simulation;
    ASPIC_TRY(auto model, build_model(run.scene.model));
    InputLog own = inputs.with_timestep(scene.model.simulation.timestep, simulation.timestep);
    ASPIC_TRY(auto files, open_files(options, run.scene, own, variants.size() + 1, overwrite));
    ASPIC_TRY(const auto last_step, as_long_as(scene.model.simulation, steps, simulation));
    auto variant = std::make_unique<HeadlessVariant>(std::move(run), shared(std::move(model)), std::move(own),
                                                     std::move(files));
    variant->last_step = last_step;
    variants.push_back(std::move(variant));
  }
  return variants;
}

/// A context for all that needs one: images, and backends that may take it. Null where nothing must have
/// one and there is none.
Result<std::shared_ptr<gl::Context>> shared_context(const RunOptions& options,
                                                    const HeadlessVariants& variants) {
  const bool needed = options.images.any() || std::ranges::any_of(variants, [](const auto& variant) {
                        const BackendRow* const row = variant->run.backend.row;
                        return row && row->needs_context;
                      });
  auto context = gl::Context::create_headless();
  if (context) return context;
  if (!needed) return std::shared_ptr<gl::Context>();
  return fail(context.error(), "images and the gpu backend need an OpenGL device. {}", context.error().what);
}

Status prepare(HeadlessVariants& variants, const std::vector<Difference>& differences, gl::Context* context,
               const InterruptGuard& interrupt) {
  for (std::size_t i = 0; i < variants.size(); ++i) {
    HeadlessVariant& m = *variants[i];
    ASPIC_TRY(m.backend, make_backend(m.run.backend, m.model, {context, nullptr, {}}));
    ASPIC_CHECK(check_log(*m.model, m.inputs, m.backend.solver->precision()));
    m.headless.emplace(*m.backend.solver, m.files, 0, true, std::move(m.inputs));
    const std::vector<OverlayLine> label = label_of(differences, m.run.scene, m.backend.variant());
    m.name = fmt::format("run {}", i + 1);
    for (const OverlayLine& line : label)
      m.name += fmt::format("{}{} {}", &line == &label.front() ? " (" : ", ", line.label, line.value);
    m.name += ")";
    warn_if_unstable(*m.model, interrupt, m.name + ": ");
    m.watch.emplace(m.run.scene.model, *m.model, true, m.backend.solver->precision());
    m.headless->set_watch(*m.watch, m.name + ": ");
  }
  return {};
}

Status draw(ComparisonRecorder& recorder, const HeadlessVariants& variants) {
  std::vector<std::uint64_t> steps;
  std::vector<std::optional<Divergence>> divergences;
  for (const auto& m : variants) {
    steps.push_back(m->headless->step());
    divergences.push_back(m->headless->divergence());
  }
  return recorder.add(steps, divergences);
}

/// The page of all runs, which goes on without the other files, and they without it.
class ComparisonPage {
 public:
  /// Opens it, where one is asked for.
  static Result<std::optional<ComparisonPage>> open(const RunOptions& options, Overwrite overwrite) {
    if (options.images.page.empty()) return std::optional<ComparisonPage>();
    ASPIC_TRY(auto writer, page::PageWriter::create(options.images.page, overwrite));
    return std::optional<ComparisonPage>(ComparisonPage(std::move(writer)));
  }
  /// Errors: usage, more images of all runs than a page holds; io.
  Status begin(const RunOptions& options, const HeadlessVariants& variants,
               const std::vector<RecordedRun>& runs, std::uint64_t images) {
    const double fps = frames_per_second(options.images);
    std::vector<page::PageRun> paged;
    std::uint64_t positions = 0;
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const Model& model = *variants[i]->model;
      paged.push_back({&variants[i]->run.scene, &model, runs[i].name});
      positions += model.particle_count() + model.ball_count();
    }
    ASPIC_CHECK(page::check_page(images, positions, fps));
    return writer_.begin({fps, options.images.speed, command_of(options.words)}, paged);
  }
  /// Where all runs are now. Error: of a run's device; one of the page is failures().
  Status add(const HeadlessVariants& variants) {
    if (!failures_.empty()) return {};
    ASPIC_CHECK(take(variants));
    std::vector<Inputs> inputs;
    for (const auto& m : variants) inputs.push_back(m->headless->solver().inputs());
    note(writer_.add(pointers(), inputs));
    return {};
  }
  Status finish(const HeadlessVariants& variants) {
    ASPIC_CHECK(add(variants));
    if (!failures_.empty()) return {};
    std::vector<std::optional<Divergence>> divergences;
    for (const auto& m : variants) divergences.push_back(m->headless->divergence());
    note(writer_.finish(pointers(), divergences));
    return {};
  }
  const std::vector<Error>& failures() const { return failures_; }
  const std::string& path() const { return writer_.path(); }

 private:
  explicit ComparisonPage(page::PageWriter writer) : writer_(std::move(writer)) {}
  void note(const Status& done) {
    if (!done) failures_.push_back(done.error());
  }
  Status take(const HeadlessVariants& variants) {
    states_.resize(variants.size());
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const HeadlessRun& headless = *variants[i]->headless;
      if (!states_[i].position.empty() && states_[i].step == headless.step()) continue;
      ASPIC_CHECK(read_state(headless.solver(), states_[i]));
    }
    return {};
  }
  std::vector<const State*> pointers() const {
    std::vector<const State*> all;
    for (const State& state : states_) all.push_back(&state);
    return all;
  }

  page::PageWriter writer_;
  std::vector<State> states_;
  std::vector<Error> failures_;
};

/// Image by image: a run that diverged stands still while the others go on, and all do without images
/// if those fail and there are other files. The result says whether all images were drawn.
Result<Status> simulate(HeadlessVariants& variants, const CommonClock& clock, ComparisonRecorder* recorder,
                        ComparisonPage* page, const InterruptGuard& interrupt) {
  for (const auto& m : variants) ASPIC_CHECK(m->headless->begin());
  ProgressBar bar(clock.count(), "image");
  bool interrupted = false;
  Losses losses, losses_of_page;
  for (std::uint64_t frame = 0; frame < clock.count() && !interrupted; ++frame) {
    for (std::size_t i = 0; i < variants.size() && !interrupted; ++i) {
      HeadlessRun& headless = *variants[i]->headless;
      const double before = headless.seconds();
      ASPIC_CHECK(headless.advance_to(std::max(clock.step_of(i, frame), headless.step()), interrupt));
      if (recorder) recorder->add_simulation(headless.seconds() - before);
      interrupted = headless.interrupted();
    }
    if (page) {
      ASPIC_CHECK(page->add(variants));
      const bool others =
          recorder || std::ranges::any_of(variants, [](const auto& m) { return m->files.any_left(); });
      if (!others && !page->failures().empty()) return page->failures().front();
      losses_of_page.tell(page->failures());
    }
    if (recorder) {
      const bool files = (page && page->failures().empty()) ||
                         std::ranges::any_of(variants, [](const auto& m) { return m->files.any_left(); });
      ASPIC_CHECK(losses.after_image(*recorder, draw(*recorder, variants), files));
      if (!losses.rendered()) recorder = nullptr;
    }
    bar.update(frame + 1);
    interrupted = interrupted || interrupt.interrupted();
    if (std::ranges::all_of(variants, [](const auto& m) { return m->headless->divergence().has_value(); }))
      break;
  }
  for (const auto& m : variants) {
    ASPIC_TRY(m->outcome, m->headless->outcome(m->last_step));
    m->outcome->interrupted = interrupted;
  }
  return losses.rendered();
}

Status print_summary(const RunOptions& options, const HeadlessVariants& variants,
                     const std::vector<std::string>& images, const ComparisonRecorder* recorder) {
  if (options.json) {
    Json runs = Json::array();
    for (const auto& m : variants) {
      Json run = to_json({m->run.scene, *m->model, m->backend, *m->outcome, m->headless->inputs()});
      run["files"] = m->files.written();
      runs.push_back(std::move(run));
    }
    const Json times = recorder ? to_json(recorder->times(), recorder->device()) : Json();
    return print_data(to_text(Json{{"runs", runs}, {"images", times}, {"files", images}}));
  }
  std::string text;
  for (const auto& m : variants) {
    text += fmt::format("{}\n{}", m->name,
                        to_text({m->run.scene, *m->model, m->backend, *m->outcome, m->headless->inputs()}));
    for (const std::string& file : m->files.written()) text += fmt::format("wrote        {}\n", file);
    text += "\n";
  }
  for (const std::string& file : images) text += fmt::format("wrote        {}\n", file);
  return print_text(text);
}

}  // namespace

Status execute_comparison(const RunOptions& options) {
  const InterruptGuard interrupt;
  ASPIC_CHECK(refuse_what_needs_one_run(options));
  std::vector<Difference> differences;
  for (const std::string& text : options.differences) {
    auto difference = parse_difference(text);
    if (!difference) return fail(difference.error(), "--variant: {}", difference.error().what);
    differences.push_back(std::move(*difference));
  }
  const Overwrite overwrite = options.force ? Overwrite::allow : Overwrite::refuse;
  std::shared_ptr<gl::Context> context;  // outlives the recorder
  ASPIC_TRY(auto variants, make_variants(options, differences, overwrite));
  ASPIC_CHECK(check_frame_count(options.images, variants.front()->model->simulation.timestep, 0,
                                variants.front()->last_step));
  ASPIC_TRY(auto video, RunFiles::open({}, options.images, {}, overwrite));
  ASPIC_TRY(auto page, ComparisonPage::open(options, overwrite));
  ASPIC_TRY(context, shared_context(options, variants));
  ASPIC_CHECK(prepare(variants, differences, context.get(), interrupt));

  std::vector<Span> spans;
  std::vector<RecordedRun> rendered;
  for (const auto& m : variants) {
    spans.push_back({m->model->simulation.timestep, m->last_step});
    rendered.push_back({&m->run.scene, &m->backend,
                        short_name(rendered.size(), differences, m->run.scene, m->backend.variant())});
  }
  const CommonClock clock(std::move(spans), frames_per_second(options.images), options.images.speed);
  if (page) ASPIC_CHECK(page->begin(options, variants, rendered, clock.count()));
  std::unique_ptr<ComparisonRecorder> recorder;
  if (options.images.any()) {
    ASPIC_TRY(recorder, ComparisonRecorder::create(*context, options.images, std::move(rendered),
                                                   video.take_frame_sinks()));
  }
  ASPIC_TRY(Status rendered_all,
            simulate(variants, clock, recorder.get(), page ? &*page : nullptr, interrupt));

  if (page) ASPIC_CHECK(page->finish(variants));
  // Images last: an encoder may keep a run waiting.
  for (const auto& m : variants) {
    Outcome& outcome = *m->outcome;
    const std::string warnings = export_text(outcome.diagnostics);
    (void)m->files.finish({.model = *m->model,
                           .state = outcome.state,
                           .solves = outcome.solves.value_or(SolveStatistics{}),
                           .inputs = &m->headless->solver().inputs(),
                           .warnings = warnings});
    outcome.actuator_work = m->files.actuator_work();
  }
  if (recorder && rendered_all) rendered_all = recorder->finish();
  std::vector<Error> lost = recorder ? recorder->failures() : std::vector<Error>{};
  if (!rendered_all && lost.empty()) lost.push_back(rendered_all.error());
  std::vector<std::string> shared = recorder ? recorder->written() : std::vector<std::string>{};
  if (page) {
    lost.insert(lost.end(), page->failures().begin(), page->failures().end());
    if (page->failures().empty()) shared.push_back(page->path());
  }
  bool others = !shared.empty();
  for (const auto& m : variants) {
    lost.insert(lost.end(), m->files.failures().begin(), m->files.failures().end());
    others = others || !m->files.written().empty();
  }
  const Status summary = print_summary(options, variants, shared, recorder.get());
  if (recorder) print_frame_times(recorder->times(), recorder->device());
  ASPIC_CHECK(lost_error(lost, others));
  if (!summary) return summary;
  for (const auto& m : variants)
    if (m->outcome->divergence) return divergence_error(*m->model, *m->outcome, interrupt, m->name);
  if (variants.front()->outcome->interrupted)
    return fail(ErrorCode::interrupted, "interrupted at step {} of {}; all files were completed.",
                variants.front()->outcome->state.step, variants.front()->last_step);
  return {};
}

}  // namespace aspic::cli
