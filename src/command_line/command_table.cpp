#include "command_line/command_table.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <string_view>
#include <type_traits>
#include <utility>

#include "aspic/version.h"
#include "command_line/checked_words.h"
#include "command_line/help_texts.h"
#include "command_line/window_layouts.h"
#include "io/state_sink.h"
#include "io/video_format.h"

namespace aspic {
namespace {

/// Repeats and particles per edge that are read at all.
constexpr WholeRange any_steps = {0, most_steps}, intervals = {1, most_steps}, few = {1, 1024},
                     repeats = {1, 1000000}, edges = {2, 1000000}, mesh_cells = {1, 256};

template <class T>
T element_of(const T&);
template <class T>
T element_of(const std::optional<T>&);
template <class T>
T element_of(const std::vector<T>&);

/// An option, or an argument where the name has no hyphens. Numbers are checked as text, whole ones against
/// `range`, and names of files must not be empty; a list takes one element each time the option is given; a
/// default is shown.
template <class T>
CLI::Option* add(CLI::App* command, const std::string& name, const char* type, T& target,
                 const std::string& help, const WholeRange& range = any_steps) {
  using Element = decltype(element_of(target));
  CLI::Option* option = command->add_option(name, target, help)->type_name(type);
  if constexpr (std::is_integral_v<Element>)
    option->transform(CLI::Validator([range](std::string& text) { return check_whole(text, range); }, ""));
  if constexpr (std::is_floating_point_v<Element>)
    option->transform(CLI::Validator([](std::string& text) { return check_number(text); }, ""));
  const std::string_view kind = type;
  if (kind == "FILE" || kind == "DIR" || kind == "SCENE")
    option->check(CLI::Validator([](std::string& text) { return check_name(text); }, ""));
  if constexpr (std::is_same_v<T, std::vector<Element>>) option->allow_extra_args(false);
  if constexpr (requires { target.empty(); }) {
    if (!target.empty()) option->capture_default_str();
  } else if constexpr (std::is_same_v<T, Element>) {
    option->capture_default_str();
  }
  return option;
}

CLI::App* add_command(CLI::App& parent, const char* name, const char* summary, const char* footer) {
  return parent.add_subcommand(name, summary)->footer(footer);
}

void add_json(CLI::App* c, bool& json, const char* help = "print the result as JSON") {
  c->add_flag("--json", json, help);
}

/// Of commands that may take a device. Processes that they start take it on.
CLI::App* with_shader_cache(CLI::App* c) {
  c->add_flag_callback(
      "--no-shader-cache", [] { ::setenv("ASPIC_SHADER_CACHE", "off", 1); },
      "compile all shaders again and cache none");
  return c;
}

void add_overrides(CLI::App* c, std::vector<std::string>& overrides) {
  add(c, "--set", "KEY=VALUE", overrides, "set a scene value, e.g. simulation.timestep=0.002; repeatable");
}

void add_arithmetic(CLI::App* c, RawOptions& raw) {
  add(c, "--arithmetic", "NAME", raw.arithmetic,
      "exact: the reference's bits, or fast: other last bits (gpu only)");
  add(c, "--threads", "N", raw.threads,
      "threads of the cpu backend, 1 to 1024; default: by size of the scene", few);
}

void add_backend(CLI::App* c, RawOptions& raw) {
  add(c, "--backend", "NAME", raw.backend, backend_words() + "; with options, gpu:gather, gpu:fast");
  add(c, "--precision", "NAME", raw.precision, "single or double (reference only); default single");
  add(c, "--force-path", "NAME", raw.force_path, force_path_words() + " (gpu only)");
  add_arithmetic(c, raw);
}

void add_length(CLI::App* c, RunLength& length) {
  auto* steps = add(c, "--steps", "N", length.steps, "simulate up to this step");
  add(c, "--duration", "S", length.duration, "simulate up to this time in seconds; default: the scene's")
      ->excludes(steps);
}

void add_images(CLI::App* c, RunOptions& run, RawOptions& raw) {
  ImageOutput& images = run.images;
  add(c, "--video", "FILE", images.video,
      fmt::format("write a video: {} (needs ffmpeg)", video_endings(false)));
  add(c, "--frames", "DIR", images.frames, "write numbered frames into a directory");
  add(c, "--html", "FILE", images.page,
      "write a page to play in a browser (.html); with --variant all runs in one");
  add(c, "--html-live", "FILE", images.page_live,
      "the same, simulated in the browser, with sliders and a check of the bits");
  add(c, "--frames-format", "NAME", raw.frames_format, video_endings(true));
  add(c, "--fps", "F", images.fps, "frames per second shown; default 60, for a GIF 50");
  add(c, "--speed", "X", images.speed, "simulated seconds per second shown: 0.25 is slow motion");
  add(c, "--size", "WxH", raw.size, "size of the images in pixels");
  add(c, "--text", "on|off", raw.text, "text on the images: on or off");
  c->add_flag("--no-text", raw.no_text, "the same as --text off");
  add(c, "--view", "KEY=VALUE", run.view,
      "set a value of the scene's view, e.g. camera.position=[8,4,12]; repeatable");
}

void add_outputs(CLI::App* c, std::vector<StateOutput>& outputs) {
  for (const std::string_view option : state_options()) outputs.push_back({std::string(option), "", {}});
  for (StateOutput& output : outputs) {
    const StateFormat& format = state_format_of(output.option, "");
    add(c, "--" + output.option, "FILE", output.path, state_help(output.option));
    // The series' interval was there first, and has the short name too.
    const char* const short_name = format.over_time ? "--every," : "";
    add(c, fmt::format("{}--{}-every", short_name, output.option), "N", output.every,
        std::string(format.every), intervals);
  }
}

CLI::App* add_run(CLI::App& app, RunOptions& run, RawOptions& raw) {
  CLI::App* c = add_command(app, "run", "Simulate a scene without a window", run_examples);
  add(c, "scene", "SCENE", run.scene, "scene file or built-in name; not needed with --resume");
  add_backend(c, raw);
  add_length(c, run.length);
  add_overrides(c, run.overrides);
  add_outputs(c, run.outputs);
  add_images(c, run, raw);
  add(c, "--variant", "KEY=VALUE", run.differences,
      "add a run with this difference, e.g. integrator=implicit-euler, h=0.002; up to three");
  add(c, "--resume", "FILE", run.resume_file,
      "continue from a checkpoint; --steps and --duration count from the scene's start");
  add(c, "--replay", "FILE", run.replay_file, "replay pulls and pins by step, saved by the window");
  c->add_flag("--force", run.force, "overwrite files");
  add_json(c, run.json, "print the summary as JSON");
  return c;
}

CLI::App* add_view(CLI::App& app, ViewOptions& view, RawOptions& raw) {
  CLI::App* c = add_command(app, "view", "Show a scene in a window", view_examples);
  add(c, "scene", "SCENE", view.scene, "scene file or built-in name");
  add(c, "--backend", "NAME", raw.backend, backend_words() + "; G switches it in the window");
  add_arithmetic(c, raw);
  add_overrides(c, view.overrides);
  add(c, "--replay", "FILE", view.replay_file, "replay pulls and pins by step, saved by the window");
  add(c, "--size", "WxH", raw.window_size, "size of the window; default: its last size");
  add(c, "--layout", "NAME", view.layout,
      fmt::format("arrangement of the panels: {}; default: the last one", fmt::join(window_layouts, ", ")));
  return c;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& compare, RawOptions& raw) {
  CLI::App* c =
      add_command(app, "compare", "Run two backends side by side and compare every step", compare_examples);
  add(c, "scene", "SCENE", compare.scene, "scene file or built-in name")->required();
  c->add_option("--backends", raw.backends,
                "the two backends, options after colons: gpu:per-spring,reference:double or gpu:fast,gpu")
      ->delimiter(',')
      ->expected(1, 100)
      ->type_name("A,B")
      ->default_str("gpu,reference");
  add(c, "--force-path", "NAME", raw.force_path, "force path of gpu backends without one");
  add_arithmetic(c, raw);
  add_length(c, compare.length);
  add_overrides(c, compare.overrides);
  add(c, "--replay", "FILE", compare.replay_file, "replay pulls and pins by step, saved by the window");
  add(c, "--tolerance", "T", compare.tolerance,
      "largest difference allowed, in m and m/s; 0: identical bits");
  add_json(c, compare.json);
  return c;
}

CLI::App* add_bench(CLI::App& app, BenchOptions& bench, RawOptions& raw) {
  CLI::App* c = add_command(app, "bench", "Measure throughput by backend, force path, size and integrator",
                            bench_examples);
  add(c, "scene", "SCENE", bench.scene, "scene file or built-in name");
  add(c, "--backend", "NAME", raw.bench_backends,
      "auto, gpu, gpu:gather, gpu:fast, cpu, reference, reference:double")
      ->delimiter(',');
  add(c, "--force-path", "NAME", raw.bench_force_paths, "force path of gpu backends without one")
      ->delimiter(',');
  add_arithmetic(c, raw);
  auto* sizes = add(c, "--size", "N", bench.sizes, "particles per edge of the scene's cubes", edges);
  sizes->delimiter(',');
  auto* integrators =
      add(c, "--integrator", "NAME", raw.bench_integrators, "integrators instead of the scene's, or all");
  integrators->delimiter(',');
  auto* timestep = add(c, "--timestep", "WORD", raw.bench_timestep,
                       "scene, or largest: 0.99 of the largest stable step, 1/60 s with implicit-euler");
  auto* seconds = add(c, "--seconds", "S", bench.seconds, "time to spend on each case");
  add(c, "--duration", "S", bench.duration, "simulated seconds of each repeat")->excludes(seconds);
  add(c, "--repeats", "N", bench.repeats, "measured runs of each case", repeats);
  add(c, "--warm-up", "N", bench.warm_up, "runs of each case before those, not counted", {0, repeats.most});
  add(c, "--images", "WxH", raw.bench_images,
      "measure rendering by pass instead, at 60 frames a simulated second")
      ->excludes(seconds, sizes, integrators, timestep);
  add_overrides(c, bench.overrides);
  add_json(c, bench.json);
  return c;
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& sweep, RawOptions& raw) {
  CLI::App* c =
      add_command(app, "sweep", "Run a scene at every point of a grid, one CSV row each", sweep_examples);
  add(c, "scene", "SCENE", sweep.scene, "scene file or built-in name")->required();
  add(c, "--vary", "KEY=VALUES", sweep.vary,
      "from:to:count[:log] or a,b,c; KEY as for --set, or integrator, h, k, c, n, e, mu, backend")
      ->required();
  add(c, "--out", "FILE", sweep.out, "the CSV file; until it is complete, FILE.partial");
  add(c, "--runs", "DIR", sweep.runs,
      "keep each finished run in this folder, also for Python: aspic.sweep()");
  add_backend(c, raw);
  add_length(c, sweep.length);
  add_overrides(c, sweep.overrides);
  add(c, "--jobs", "N", sweep.jobs,
      "runs at once; default: the number of CPU cores, or 1 where runs need a GPU", few);
  add(c, "--part", "I/N", raw.part, "the I-th of N equal parts of the grid, for job arrays");
  c->add_flag("--force", sweep.force, "overwrite the file and start over");
  add_json(c, sweep.json, "print the numbers of rows as JSON");
  return c;
}

CLI::App* add_report(CLI::App& app, ReportOptions& report) {
  CLI::App* c =
      add_command(app, "report", "Compare integrators and parameters on a page with plots", report_examples);
  add(c, "scene", "SCENE", report.scene, "scene file or built-in name");
  add(c, "--out", "DIR", report.out, "directory for report.html, report.md, report.pdf, data and figures")
      ->required();
  add(c, "--only", "NAME", report.only,
      "one section: integrators, parameters, stability, contact or backends; repeatable");
  add(c, "--outline", "NAME", report.outline,
      "order of chapters, with gaps for your own text: course (at most 10 pages)");
  c->add_flag("--thorough", report.thorough, "finer maps, longer runs, larger sizes");
  add(c, "--jobs", "N", report.jobs, "threads; default: the number of CPU cores", few);
  add_overrides(c, report.overrides);
  c->add_flag("--force", report.force, "overwrite a report");
  add_json(c, report.json, "print the names of the files as JSON");
  return c;
}

CLI::App* add_verify(CLI::App& app, VerifyOptions& verify) {
  CLI::App* c = add_command(
      app, "verify", "Check physics and equivalence on this machine, as a table of values", verify_examples);
  c->add_flag("--quick", verify.quick, "run only checks that take seconds");
  add(c, "--only", "NAME", verify.only, "run one check or group, e.g. order or rest/midpoint; repeatable");
  c->add_flag("--list", verify.list, "list names and claims of the checks without a run");
  c->add_flag("--require-gpu", verify.require_gpu,
              "fail if a check finds no GL device, instead of skipping it");
  add_json(c, verify.json, "print the table as JSON");
  return c;
}

/// The four commands below `scene`, in their order.
std::array<CLI::App*, 4> add_scene(CLI::App& app, SceneListOptions& list, SceneShowOptions& show,
                                   SceneCheckOptions& check, SceneImportOptions& import) {
  CLI::App* scene = add_command(app, "scene", "List, show, check and import scenes", scene_examples);
  scene->require_subcommand(1);
  CLI::App* c = add_command(*scene, "list", "The built-in scenes", scene_list_examples);
  add_json(c, list.json, "print JSON");
  CLI::App* s =
      add_command(*scene, "show", "Print a scene as complete TOML, with every default", scene_show_examples);
  add(s, "scene", "SCENE", show.scene, "scene file or built-in name")->required();
  add_overrides(s, show.overrides);
  CLI::App* k =
      add_command(*scene, "check", "Counts, memory and stable time steps of a scene", scene_check_examples);
  add(k, "scene", "SCENE", check.scene, "scene file or built-in name")->required();
  add_json(k, check.json, "print JSON");
  add_overrides(k, check.overrides);
  CLI::App* i =
      add_command(*scene, "import", "Print a mesh, or Configuration.txt of the 2018 framework, as a scene",
                  scene_import_examples);
  add(i, "file", "FILE", import.file, "mesh (.obj, .stl, .ply, or the built-in rabbit), or Configuration.txt")
      ->required();
  add(i, "--cells", "N", import.cells, "cells along the longest edge of a mesh; default 24", mesh_cells);
  add(i, "--height", "M", import.height,
      "height in meters to scale a mesh to; default: its numbers are meters");
  add(i, "--up", "AXIS", import.up, "axis of a mesh that points upwards, y or z; default y");
  add(i, "--pieces", "WORD", import.pieces, "disconnected parts: largest (default), all or refuse");
  return {c, s, k, i};
}

CLI::App* add_info(CLI::App& app, InfoOptions& info) {
  CLI::App* c =
      add_command(app, "info", "List devices, drivers, GL limits, and the choice of auto", info_examples);
  add_json(c, info.json, "print JSON");
  return c;
}

}  // namespace

CommandTable::CommandTable(Finish finish)
    : app("Soft bodies of point masses and springs on OpenGL compute", "aspic"), finish_(std::move(finish)) {
  app.footer(main_examples);
  app.set_version_flag("--version", "aspic " ASPIC_VERSION);
  app.require_subcommand(1);
  on(with_shader_cache(add_run(app, run, raw)), [this] { return finish_run(run, raw); });
  on(with_shader_cache(add_view(app, view, raw)), [this] { return finish_view(view, raw); });
  on(with_shader_cache(add_compare(app, compare, raw)), [this] { return finish_compare(compare, raw); });
  on(with_shader_cache(add_bench(app, bench, raw)), [this] { return finish_bench(bench, raw); });
  on(with_shader_cache(add_sweep(app, sweep, raw)), [this] { return finish_sweep(sweep, raw); });
  on(with_shader_cache(add_report(app, report)), [this] { return Command(report); });
  on(with_shader_cache(add_verify(app, verify)), [this] { return Command(verify); });
  const auto scenes = add_scene(app, list, show, check, import);
  on(scenes[0], [this] { return Command(list); });
  on(scenes[1], [this] { return Command(show); });
  on(scenes[2], [this] { return Command(check); });
  on(scenes[3], [this] { return finish_import(import); });
  on(with_shader_cache(add_info(app, info)), [this] { return Command(info); });
}

void CommandTable::on(CLI::App* command, std::function<Result<Command>()> complete) {
  command->callback([this, command, complete = std::move(complete)] { finish_(*command, complete); });
}

}  // namespace aspic
