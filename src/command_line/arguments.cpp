#include "command_line/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <string_view>

#include "base/printable.h"
#include "command_line/number_checks.h"
#include "command_line/raw_options.h"
#include "scene/diagnostics.h"

namespace aspic {
namespace {

constexpr const char* main_examples = R"(Examples:
  aspic run cube-plane                              simulate a built-in scene, print a summary
  aspic run my-scene.toml --duration 2 --state end.csv --series energy.csv --every 10
  aspic run cube-plane --set simulation.timestep=0.002 --set "cube[0].shear.stiffness=10"
  aspic view cube-bowl                              the window; F1 there shows all keys
  aspic compare cube-plane --backends gpu,reference --steps 1000
  aspic verify --quick                              check this build on this machine
  aspic scene check my-scene.toml                   counts, memory and stable time steps
  aspic info                                        devices and limits

SCENE is a TOML file or the name of a built-in scene (aspic scene list).
Exit codes: 0 ok, 1 comparison or verification failed, 2 usage, 3 scene rejected, 4 no usable
GL device, 5 diverged, 6 input/output failed, 130 interrupted.)";

constexpr const char* run_examples = R"(Examples:
  aspic run cube-plane --steps 1000 --json
  aspic run cube-sphere --backend reference --precision double --state end.csv
  aspic run cube-bowl --video bowl.mp4 --speed 0.5 --view colour=strain
  aspic run cube-plane --frames out --fps 30 --size 640x360 --no-text
  aspic run cube-plane --duration 2 --checkpoint half.aspic
  aspic run --resume half.aspic --duration 4 --state end.csv)";

constexpr const char* view_examples = R"(Examples:
  aspic view                                        the first built-in scene; F1 shows all keys
  aspic view cube-sphere --backend gpu
  aspic view my-scene.toml --set simulation.timestep=0.002 --size 1600x900

Left drag turns the camera, right or Shift drag moves it, the wheel zooms; Space starts and pauses, G changes between
the GPU and the reference in mid-motion, Tab hides the panels.)";

constexpr const char* compare_examples = R"(Examples:
  aspic compare cube-plane --steps 1000
  aspic compare cube-bowl --backends gpu:gather,gpu:per-spring --steps 500
  aspic compare cube-plane --backends reference,reference:double --steps 100 --tolerance 1e-4)";

constexpr const char* bench_examples = R"(Examples:
  aspic bench --backend reference --backend gpu:gather --backend gpu:per-spring --size 10 --size 20
  aspic bench large-cube --seconds 10 --json
  aspic bench --integrator explicit-euler --integrator implicit-euler --timestep largest --duration 1

Each case runs --repeats times over the same steps from the scene's start; the median counts, the spread is
(slowest - fastest) / median. Spring evaluations are springs x force evaluations x steps; with implicit-euler
an application of the Jacobian counts as one. A software rasteriser's figures are no GPU's: the renderer is named.)";

constexpr const char* verify_examples = R"(Examples:
  aspic verify                                      everything, a few minutes
  aspic verify --quick
  aspic verify --only equality --only repeat --require-gpu

Exit code 1 if a check fails. Without a GL device the checks that need one are reported as not run.)";

struct NotBuilt {
  std::string_view command, what;
};
constexpr std::array<NotBuilt, 1> not_built_commands = {{
    {"report", "the report with plots"},
}};

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
  return usage(message + fmt::format(" See {} --help.", full_name(command)));
}

CLI::Validator whole(std::uint64_t most) {
  return {[most](std::string& text) { return check_whole(text, most); }, ""};
}
CLI::Validator number() {
  return {[](std::string& text) { return check_number(text); }, ""};
}

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "set a scene value, e.g. simulation.timestep=0.002; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_length(CLI::App& command, RunLength& length) {
  auto* steps = command.add_option("--steps", length.steps, "simulate up to this step")
                    ->type_name("N")
                    ->transform(whole(most_steps));
  command
      .add_option("--duration", length.duration, "simulate up to this time, in seconds; default: the scene's")
      ->type_name("S")
      ->transform(number())
      ->excludes(steps);
}

void add_pictures(CLI::App& command, RunOptions& run, RawOptions& raw) {
  PictureOutput& pictures = run.pictures;
  command
      .add_option("--video", pictures.video,
                  fmt::format("write a video: {} (needs ffmpeg)", film_endings(false)))
      ->type_name("FILE");
  command.add_option("--frames", pictures.frames, "write numbered pictures into a directory")
      ->type_name("DIR");
  command.add_option("--frames-format", raw.frames_format, film_endings(true))
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--fps", pictures.fps, "pictures per second shown; default 60, for a GIF 50")
      ->type_name("F")
      ->transform(number());
  command.add_option("--speed", pictures.speed, "simulated seconds per second shown: 0.25 is slow motion")
      ->capture_default_str()
      ->type_name("X")
      ->transform(number());
  command.add_option("--size", raw.size, "size of the pictures in pixels")
      ->capture_default_str()
      ->type_name("WxH");
  command.add_option("--text", raw.text, "text on the pictures: on or off")
      ->capture_default_str()
      ->type_name("on|off");
  command.add_flag("--no-text", raw.no_text, "the same as --text off");
  command
      .add_option("--view", run.view,
                  "set a value of the scene's view, e.g. camera.position=[8,4,12]; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_outputs(CLI::App& command, std::vector<StateOutput>& outputs) {
  for (const std::string_view option : state_options()) outputs.push_back({std::string(option), "", {}});
  for (StateOutput& output : outputs) {
    const StateFormat& format = state_format_of(output.option, "");
    auto* file =
        command.add_option("--" + output.option, output.path, state_help(output.option))->type_name("FILE");
    // The series' interval was there first, and has the short name too.
    const char* const short_name = format.over_time ? "--every," : "";
    command
        .add_option(fmt::format("{}--{}-every", short_name, output.option), output.every,
                    std::string(format.every))
        ->type_name("N")
        ->transform(whole(most_steps))
        ->needs(file);
  }
}

CLI::App* add_run(CLI::App& app, RunOptions& run, RawOptions& raw) {
  CLI::App* c = app.add_subcommand("run", "Simulate a scene headless");
  c->add_option("scene", run.scene, "scene file or built-in name; not needed with --resume")
      ->type_name("SCENE");
  c->add_option("--backend", raw.backend, backend_words())->capture_default_str()->type_name("NAME");
  c->add_option("--precision", raw.precision, "single or double (reference only); default single")
      ->type_name("NAME");
  c->add_option("--force-path", raw.force_path, force_path_words() + " (gpu only)")
      ->capture_default_str()
      ->type_name("NAME");
  add_length(*c, run.length);
  add_overrides(*c, run.overrides);
  add_outputs(*c, run.outputs);
  add_pictures(*c, run, raw);
  c->add_option("--resume", run.resume_file,
                "continue from a checkpoint; --steps and --duration count from its start")
      ->type_name("FILE");
  c->add_flag("--force", run.force, "overwrite files");
  c->add_flag("--json", run.json, "summary on stdout as JSON");
  c->footer(run_examples);
  return c;
}

CLI::App* add_view(CLI::App& app, ViewOptions& view, RawOptions& raw) {
  CLI::App* c = app.add_subcommand("view", "Show a scene in a window");
  c->add_option("scene", view.scene, "scene file or built-in name")
      ->type_name("SCENE")
      ->capture_default_str();
  c->add_option("--backend", raw.backend, backend_words() + "; G switches it in the window")
      ->capture_default_str()
      ->type_name("NAME");
  add_overrides(*c, view.overrides);
  c->add_option("--size", raw.window_size, "size of the window; default: its last size")->type_name("WxH");
  c->footer(view_examples);
  return c;
}

CLI::App* add_compare(CLI::App& app, CompareOptions& compare, RawOptions& raw) {
  CLI::App* c = app.add_subcommand("compare", "Run two backends side by side, step by step");
  c->add_option("scene", compare.scene, "scene file or built-in name")->type_name("SCENE")->required();
  c->add_option("--backends", raw.backends,
                "the two backends, options after colons: gpu:per-spring,reference:double")
      ->delimiter(',')
      ->expected(2)
      ->type_name("A,B")
      ->capture_default_str();
  c->add_option("--force-path", raw.force_path, "force path of gpu backends without their own")
      ->type_name("NAME");
  add_length(*c, compare.length);
  add_overrides(*c, compare.overrides);
  c->add_option("--tolerance", compare.tolerance,
                "largest difference allowed, in m and m/s; 0: identical bits")
      ->capture_default_str()
      ->type_name("T")
      ->transform(number());
  c->add_flag("--json", compare.json, "result on stdout as JSON");
  c->footer(compare_examples);
  return c;
}

CLI::App* add_bench(CLI::App& app, BenchOptions& bench, RawOptions& raw) {
  CLI::App* c = app.add_subcommand("bench", "Measure throughput by backend, force path, size and integrator");
  c->add_option("scene", bench.scene, "scene file or built-in name")
      ->type_name("SCENE")
      ->capture_default_str();
  c->add_option("--backend", raw.bench_backends,
                "auto, gpu, gpu:per-spring, reference, reference:double; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->capture_default_str();
  c->add_option("--force-path", raw.bench_force_paths, "of gpu backends without their own; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  c->add_option("--size", bench.sizes, "particles per edge of the scene's cubes; repeatable")
      ->type_name("N")
      ->transform(whole(1000000))
      ->allow_extra_args(false);
  c->add_option("--integrator", raw.bench_integrators, "instead of the scene's; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  c->add_option("--timestep", raw.bench_timestep,
                "scene, or largest: 0.99 of the largest stable step, 1/60 s with implicit-euler")
      ->type_name("WORD")
      ->capture_default_str();
  auto* seconds = c->add_option("--seconds", bench.seconds, "time to spend on each case")
                      ->type_name("S")
                      ->transform(number())
                      ->capture_default_str();
  c->add_option("--duration", bench.duration, "simulated seconds of each repeat, however long they take")
      ->type_name("S")
      ->transform(number())
      ->excludes(seconds);
  c->add_option("--repeats", bench.repeats, "runs of each case")
      ->type_name("N")
      ->transform(whole(1000000))
      ->capture_default_str();
  add_overrides(*c, bench.overrides);
  c->add_flag("--json", bench.json, "result on stdout as JSON");
  c->footer(bench_examples);
  return c;
}

CLI::App* add_verify(CLI::App& app, VerifyOptions& verify) {
  CLI::App* c =
      app.add_subcommand("verify", "Check physics and equivalence on this machine, as a table of figures");
  c->add_flag("--quick", verify.quick, "only checks that take seconds");
  c->add_option("--only", verify.only, "one check or group, e.g. order or rest/midpoint; repeatable")
      ->type_name("NAME")
      ->allow_extra_args(false);
  c->add_flag("--require-gpu", verify.require_gpu,
              "fail if a check finds no GL device, instead of skipping it");
  c->add_flag("--json", verify.json, "the table on stdout as JSON");
  c->footer(verify_examples);
  return c;
}

}  // namespace

Result<Command> parse_arguments(int argc, const char* const* argv) {
  CLI::App app("Soft bodies of point masses and springs on OpenGL compute", "aspic");
  app.footer(main_examples);
  app.set_version_flag("--version", "aspic " ASPIC_VERSION);
  app.require_subcommand(1);
  RawOptions raw;
  RunOptions run;
  CompareOptions compare;
  VerifyOptions verify;
  SceneListOptions list;
  SceneShowOptions show;
  SceneCheckOptions check;
  InfoOptions info;
  CLI::App* run_command = add_run(app, run, raw);
  ViewOptions view;
  CLI::App* view_command = add_view(app, view, raw);
  CLI::App* compare_command = add_compare(app, compare, raw);
  BenchOptions bench;
  CLI::App* bench_command = add_bench(app, bench, raw);
  CLI::App* verify_command = add_verify(app, verify);
  CLI::App* scene = app.add_subcommand("scene", "List, show, check and import scenes");
  scene->require_subcommand(1);
  CLI::App* list_command = scene->add_subcommand("list", "The built-in scenes");
  list_command->add_flag("--json", list.json, "as JSON");
  CLI::App* show_command =
      scene->add_subcommand("show", "Print a scene as complete TOML, with every default");
  show_command->add_option("scene", show.scene, "scene file or built-in name")
      ->type_name("SCENE")
      ->required();
  add_overrides(*show_command, show.overrides);
  CLI::App* check_command = scene->add_subcommand("check", "Counts, memory and stable time steps of a scene");
  check_command->add_option("scene", check.scene, "scene file or built-in name")
      ->type_name("SCENE")
      ->required();
  check_command->add_flag("--json", check.json, "as JSON");
  add_overrides(*check_command, check.overrides);
  SceneImportOptions import;
  CLI::App* import_command =
      scene->add_subcommand("import", "Print Configuration.txt of the 2018 framework as a scene");
  import_command->add_option("file", import.file, "the file to read")->type_name("FILE")->required();
  CLI::App* info_command = app.add_subcommand("info", "Devices, drivers, GL limits, and what auto picks");
  info_command->add_flag("--json", info.json, "as JSON");

  if (argc < 2) return usage("no command given.\n\n" + app.help());
  const std::string first = argv[1];
  for (const NotBuilt& entry : not_built_commands) {
    if (first == entry.command) {
      return usage(fmt::format("aspic {} ({}) is not built yet in version {}.", entry.command, entry.what,
                               ASPIC_VERSION));
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    return Command(ShowText{"aspic " ASPIC_VERSION "\n"});
  } catch (const CLI::Success&) {
    return Command(ShowText{named_command(app).help()});
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
    return usage(fmt::format("{}. See {} --help.", error.what(), full_name(command)));
  }
  if (*run_command) return finish_run(std::move(run), raw);
  if (*view_command) {
    view.words.assign(argv + 2, argv + argc);
    return finish_view(std::move(view), raw);
  }
  if (*compare_command) return finish_compare(std::move(compare), raw);
  if (*bench_command) return finish_bench(std::move(bench), raw);
  if (*verify_command) return Command(std::move(verify));
  if (*list_command) return Command(list);
  if (*show_command) return Command(std::move(show));
  if (*check_command) return Command(std::move(check));
  if (*import_command) return Command(std::move(import));
  return Command(info);
}

}  // namespace aspic
