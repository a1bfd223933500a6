#include "command_line/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>
#include <type_traits>

#include "base/printable.h"
#include "command_line/checked_words.h"
#include "command_line/help_texts.h"
#include "command_line/raw_options.h"
#include "command_line/window_layouts.h"
#include "scene/diagnostics.h"

namespace aspic {
namespace {

/// Largest number of repeats and of particles per edge that is read at all.
constexpr std::uint64_t most_of_int = 1000000;

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The deepest command that was named.
const CLI::App& named_command(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : named_command(*parsed.front());
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() ? full_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

/// A sentence for words that no option or argument takes.
Error unexpected_word(const CLI::App& command, const std::string& word) {
  const bool option = word.starts_with('-');
  const std::string shown = printable_line(word);
  const std::string name = shown.substr(0, shown.find('='));
  const std::vector<std::string> known = option ? option_names(command) : command_names(command);
  std::string message = option          ? fmt::format("{} has no option {}.", full_name(command), name)
                        : known.empty() ? fmt::format("{} does not expect \"{}\".", full_name(command), shown)
                                        : fmt::format("{} has no command \"{}\".", full_name(command), shown);
  const std::vector<std::string_view> candidates(known.begin(), known.end());
  const std::string_view near = diagnostics::nearest(name, candidates);
  if (!near.empty()) message += fmt::format(" Did you mean {}?", near);
  return usage("{} See {} --help.", message, full_name(command));
}

template <class T>
T element_of(const T&);
template <class T>
T element_of(const std::optional<T>&);
template <class T>
T element_of(const std::vector<T>&);

/// An option, or an argument where the name has no hyphens. Numbers are checked as text, whole ones up to
/// `most`; a list takes one element each time the option is given; a default is shown.
template <class T>
CLI::Option* add(CLI::App* command, const std::string& name, const char* type, T& target,
                 const std::string& help, std::uint64_t most = most_steps) {
  using Element = decltype(element_of(target));
  CLI::Option* option = command->add_option(name, target, help)->type_name(type);
  if constexpr (std::is_integral_v<Element>)
    option->transform(CLI::Validator([most](std::string& text) { return check_whole(text, most); }, ""));
  if constexpr (std::is_floating_point_v<Element>)
    option->transform(CLI::Validator([](std::string& text) { return check_number(text); }, ""));
  if constexpr (std::is_same_v<T, std::vector<Element>>) option->allow_extra_args(false);
  if constexpr (requires { target.empty(); }) {
    if (!target.empty()) option->capture_default_str();
  } else if constexpr (std::is_same_v<T, Element>) {
    option->capture_default_str();
  }
  return option;
}

/// Without a footer of its own it has that of its parent.
CLI::App* add_command(CLI::App& parent, const char* name, const char* summary, const char* footer = "") {
  CLI::App* command = parent.add_subcommand(name, summary);
  return *footer ? command->footer(footer) : command;
}

void add_json(CLI::App* c, bool& json, const char* help = "result on stdout as JSON") {
  c->add_flag("--json", json, help);
}

void add_overrides(CLI::App* c, std::vector<std::string>& overrides) {
  add(c, "--set", "KEY=VALUE", overrides, "set a scene value, e.g. simulation.timestep=0.002; repeatable");
}

void add_arithmetic(CLI::App* c, RawOptions& raw) {
  add(c, "--arithmetic", "NAME", raw.arithmetic,
      "exact: the reference's bits, or fast: other last bits (gpu and cpu)");
  add(c, "--threads", "N", raw.threads, "threads of the cpu backend, 1 to 1024; default: as many as pay",
      1024);
}

void add_backend(CLI::App* c, RawOptions& raw) {
  add(c, "--backend", "NAME", raw.backend, backend_words());
  add(c, "--precision", "NAME", raw.precision, "single or double (reference only); default single");
  add(c, "--force-path", "NAME", raw.force_path, force_path_words() + " (gpu only)");
  add_arithmetic(c, raw);
}

void add_length(CLI::App* c, RunLength& length) {
  auto* steps = add(c, "--steps", "N", length.steps, "simulate up to this step");
  add(c, "--duration", "S", length.duration, "simulate up to this time, in seconds; default: the scene's")
      ->excludes(steps);
}

void add_pictures(CLI::App* c, RunOptions& run, RawOptions& raw) {
  PictureOutput& pictures = run.pictures;
  add(c, "--video", "FILE", pictures.video,
      fmt::format("write a video: {} (needs ffmpeg)", film_endings(false)));
  add(c, "--frames", "DIR", pictures.frames, "write numbered pictures into a directory");
  add(c, "--frames-format", "NAME", raw.frames_format, film_endings(true));
  add(c, "--fps", "F", pictures.fps, "pictures per second shown; default 60, for a GIF 50");
  add(c, "--speed", "X", pictures.speed, "simulated seconds per second shown: 0.25 is slow motion");
  add(c, "--size", "WxH", raw.size, "size of the pictures in pixels");
  add(c, "--text", "on|off", raw.text, "text on the pictures: on or off");
  c->add_flag("--no-text", raw.no_text, "the same as --text off");
  add(c, "--view", "KEY=VALUE", run.view,
      "set a value of the scene's view, e.g. camera.position=[8,4,12]; repeatable");
}

void add_outputs(CLI::App* c, std::vector<StateOutput>& outputs) {
  for (const std::string_view option : state_options()) outputs.push_back({std::string(option), "", {}});
  for (StateOutput& output : outputs) {
    const StateFormat& format = state_format_of(output.option, "");
    auto* file = add(c, "--" + output.option, "FILE", output.path, state_help(output.option));
    // The series' interval was there first, and has the short name too.
    const char* const short_name = format.over_time ? "--every," : "";
    add(c, fmt::format("{}--{}-every", short_name, output.option), "N", output.every,
        std::string(format.every))
        ->needs(file);
  }
}

CLI::App* add_run(CLI::App& app, RunOptions& run, RawOptions& raw) {
  CLI::App* c = add_command(app, "run", "Simulate a scene headless", run_examples);
  add(c, "scene", "SCENE", run.scene, "scene file or built-in name; not needed with --resume");
  add_backend(c, raw);
  add_length(c, run.length);
  add_overrides(c, run.overrides);
  add_outputs(c, run.outputs);
  add_pictures(c, run, raw);
  add(c, "--beside", "KEY=VALUE", run.beside,
      "a run with this difference beside the scene's own, e.g. integrator=implicit-euler, h=0.002, k=500, "
      "backend=reference or a key of --set; up to three");
  add(c, "--resume", "FILE", run.resume_file,
      "continue from a checkpoint; --steps and --duration count from its start");
  c->add_flag("--force", run.force, "overwrite files");
  add_json(c, run.json, "summary on stdout as JSON");
  return c;
}

CLI::App* add_view(CLI::App& app, ViewOptions& view, RawOptions& raw) {
  CLI::App* c = add_command(app, "view", "Show a scene in a window", view_examples);
  add(c, "scene", "SCENE", view.scene, "scene file or built-in name");
  add(c, "--backend", "NAME", raw.backend, backend_words() + "; G switches it in the window");
  add_arithmetic(c, raw);
  add_overrides(c, view.overrides);
  add(c, "--size", "WxH", raw.window_size, "size of the window; default: its last size");
  add(c, "--layout", "NAME", view.layout,
      fmt::format("arrangement of the panels: {}; default: the last one", fmt::join(window_layouts, ", ")));
  return c;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& compare, RawOptions& raw) {
  CLI::App* c = add_command(app, "compare", "Run two backends side by side, step by step", compare_examples);
  add(c, "scene", "SCENE", compare.scene, "scene file or built-in name")->required();
  c->add_option("--backends", raw.backends,
                "the two backends, options after colons: gpu:per-spring,reference:double or cpu:fast,cpu")
      ->delimiter(',')
      ->expected(2)
      ->type_name("A,B")
      ->capture_default_str();
  add(c, "--force-path", "NAME", raw.force_path, "force path of gpu backends without their own");
  add_arithmetic(c, raw);
  add_length(c, compare.length);
  add_overrides(c, compare.overrides);
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
      "auto, gpu, gpu:gather, gpu:fast, cpu, cpu:fast, reference, reference:double")
      ->delimiter(',');
  add(c, "--force-path", "NAME", raw.bench_force_paths, "of gpu backends without their own")->delimiter(',');
  add_arithmetic(c, raw);
  auto* sizes = add(c, "--size", "N", bench.sizes, "particles per edge of the scene's cubes", most_of_int);
  sizes->delimiter(',');
  auto* integrators = add(c, "--integrator", "NAME", raw.bench_integrators, "instead of the scene's, or all");
  integrators->delimiter(',');
  auto* timestep = add(c, "--timestep", "WORD", raw.bench_timestep,
                       "scene, or largest: 0.99 of the largest stable step, 1/60 s with implicit-euler");
  auto* seconds = add(c, "--seconds", "S", bench.seconds, "time to spend on each case");
  add(c, "--duration", "S", bench.duration, "simulated seconds of each repeat, however long they take")
      ->excludes(seconds);
  add(c, "--repeats", "N", bench.repeats, "runs of each case", most_of_int);
  add(c, "--warm-up", "N", bench.warm_up, "runs of each case before them, not counted", most_of_int);
  auto* peers = c->add_flag("--peers", bench.with_peers,
                            "beside other programs with the same cube, from a source checkout");
  auto* peer = add(c, "--peer", "NAME", bench.peers, "beside this one alone, e.g. textbook")->delimiter(',');
  add(c, "--pictures", "WxH", raw.bench_pictures,
      "what drawing the scene costs instead, by pass, 60 pictures a simulated second")
      ->excludes(peers, peer, seconds, sizes, integrators, timestep);
  add_overrides(c, bench.overrides);
  add_json(c, bench.json);
  return c;
}

CLI::App* add_sweep(CLI::App& app, SweepOptions& sweep, RawOptions& raw) {
  CLI::App* c =
      add_command(app, "sweep", "Run a scene at every point of a grid, a CSV row each", sweep_examples);
  add(c, "scene", "SCENE", sweep.scene, "scene file or built-in name")->required();
  add(c, "--vary", "KEY=VALUES", sweep.vary,
      "from:to:count, from:to:count:log or a,b,c; KEY as for --set, or integrator, h, k, c, n, e, mu, "
      "backend; repeatable")
      ->required();
  add(c, "--out", "FILE", sweep.out, "the CSV file; until it is complete, FILE.partial")->required();
  add_backend(c, raw);
  add_length(c, sweep.length);
  add_overrides(c, sweep.overrides);
  add(c, "--jobs", "N", sweep.jobs, "runs at once; default: the processors, or 1 where runs take a GPU",
      1024);
  add(c, "--part", "I/N", raw.part, "the I-th of N equal parts of the grid, for job arrays");
  c->add_flag("--force", sweep.force, "overwrite the file, and begin anew");
  add_json(c, sweep.json, "numbers of rows on stdout as JSON");
  c->add_flag("--worker", sweep.worker)->group("");  // what the sweep starts
  return c;
}

CLI::App* add_report(CLI::App& app, ReportOptions& report) {
  CLI::App* c =
      add_command(app, "report", "Compare integrators and parameters, as a page with plots", report_examples);
  add(c, "scene", "SCENE", report.scene, "scene file or built-in name");
  add(c, "--out", "DIR", report.out, "directory for report.html, report.md, report.pdf, data and figures")
      ->required();
  add(c, "--only", "NAME", report.only,
      "one section: integrators, parameters, stability, contact or backends; repeatable");
  c->add_flag("--thorough", report.thorough, "finer maps, longer runs, larger sizes");
  add(c, "--jobs", "N", report.jobs, "threads; default: the processors", 1024);
  add_overrides(c, report.overrides);
  c->add_flag("--force", report.force, "overwrite a report");
  add_json(c, report.json, "names of the files on stdout as JSON");
  return c;
}

CLI::App* add_verify(CLI::App& app, VerifyOptions& verify) {
  CLI::App* c = add_command(
      app, "verify", "Check physics and equivalence on this machine, as a table of figures", verify_examples);
  c->add_flag("--quick", verify.quick, "only checks that take seconds");
  add(c, "--only", "NAME", verify.only, "one check or group, e.g. order or rest/midpoint; repeatable");
  c->add_flag("--require-gpu", verify.require_gpu,
              "fail if a check finds no GL device, instead of skipping it");
  add_json(c, verify.json, "the table on stdout as JSON");
  return c;
}

/// The four commands below `scene`, in their order.
std::array<CLI::App*, 4> add_scene(CLI::App& app, SceneListOptions& list, SceneShowOptions& show,
                                   SceneCheckOptions& check, SceneImportOptions& import) {
  CLI::App* scene = add_command(app, "scene", "List, show, check and import scenes");
  scene->require_subcommand(1);
  CLI::App* c = add_command(*scene, "list", "The built-in scenes");
  add_json(c, list.json, "as JSON");
  CLI::App* s = add_command(*scene, "show", "Print a scene as complete TOML, with every default");
  add(s, "scene", "SCENE", show.scene, "scene file or built-in name")->required();
  add_overrides(s, show.overrides);
  CLI::App* k = add_command(*scene, "check", "Counts, memory and stable time steps of a scene");
  add(k, "scene", "SCENE", check.scene, "scene file or built-in name")->required();
  add_json(k, check.json, "as JSON");
  add_overrides(k, check.overrides);
  CLI::App* i = add_command(*scene, "import", "Print Configuration.txt of the 2018 framework as a scene");
  add(i, "file", "FILE", import.file, "the file to read")->required();
  return {c, s, k, i};
}

}  // namespace

Result<Command> parse_arguments(int argc, const char* const* argv) {
  CLI::App app("Soft bodies of point masses and springs on OpenGL compute", "aspic");
  app.footer(main_examples);
  app.set_version_flag("--version", "aspic " ASPIC_VERSION);
  app.require_subcommand(1);
  RawOptions raw;
  RunOptions run;
  ViewOptions view;
  CompareOptions compare;
  BenchOptions bench;
  SweepOptions sweep;
  ReportOptions report;
  VerifyOptions verify;
  SceneListOptions list;
  SceneShowOptions show;
  SceneCheckOptions check;
  SceneImportOptions import;
  InfoOptions info;
  std::optional<Result<Command>> result;
  const auto on = [&](CLI::App* command, auto finish) {
    command->callback([&result, finish] { result.emplace(finish()); });
  };
  on(add_run(app, run, raw), [&] { return finish_run(run, raw); });
  on(add_view(app, view, raw), [&] {
    view.words.assign(argv + 2, argv + argc);
    return finish_view(view, raw);
  });
  on(add_compare(app, compare, raw), [&] { return finish_compare(compare, raw); });
  on(add_bench(app, bench, raw), [&] { return finish_bench(bench, raw); });
  on(add_sweep(app, sweep, raw), [&] {
    sweep.words.assign(argv + 2, argv + argc);
    return finish_sweep(sweep, raw);
  });
  on(add_report(app, report), [&] { return Command(report); });
  on(add_verify(app, verify), [&] { return Command(verify); });
  const auto scenes = add_scene(app, list, show, check, import);
  on(scenes[0], [&] { return Command(list); });
  on(scenes[1], [&] { return Command(show); });
  on(scenes[2], [&] { return Command(check); });
  on(scenes[3], [&] { return Command(import); });
  CLI::App* info_command = add_command(app, "info", "Devices, drivers, GL limits, and what auto picks");
  add_json(info_command, info.json, "as JSON");
  on(info_command, [&] { return Command(info); });

  if (argc < 2) return usage("no command given.\n\n{}", app.help());
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    return Command(ShowText{"aspic " ASPIC_VERSION "\n"});
  } catch (const CLI::Success&) {
    const CLI::App& command = named_command(app);
    return Command(ShowText{command.help(command.get_parent() ? full_name(*command.get_parent()) : "")});
  } catch (const CLI::ParseError& error) {
    const CLI::App& command = named_command(app);
    const auto extras = command.remaining();
    // Where a command is missing, CLI11 reports that before the word in its place.
    const bool command_missing =
        command.get_require_subcommand_min() > 0 && command.get_subcommands().empty();
    if (!extras.empty()) return unexpected_word(command, extras.front());
    if (command_missing) {
      for (int i = &command == &app ? 1 : 2; i < argc; ++i) {
        const std::string word = argv[i];
        if (word != command.get_name()) return unexpected_word(command, word);
      }
    }
    return usage("{}. See {} --help.", error.what(), full_name(command));
  }
  return std::move(*result);
}

}  // namespace aspic
