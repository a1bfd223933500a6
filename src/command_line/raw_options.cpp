#include "command_line/raw_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "base/files.h"
#include "base/printable.h"
#include "command_line/window_layouts.h"
#include "io/video_format.h"
#include "page/page_writer.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

Status check_length(const RunLength& length) {
  if (length.duration && !(std::isfinite(*length.duration) && *length.duration >= 0.0)) {
    return usage("--duration must be a finite number of seconds, 0 or more, not {}.", *length.duration);
  }
  return {};
}

/// "1280x720". The limits are those that every OpenGL 4.3 device takes.
Result<ImageSize> parse_size(const std::string& text, std::string_view option = "--size") {
  ImageSize size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    constexpr int least = 16, most = 16384;
    if (height.ec == std::errc() && height.ptr == end && std::min(size.width, size.height) >= least &&
        std::max(size.width, size.height) <= most)
      return size;
  }
  return usage("{} must be WIDTHxHEIGHT in pixels, each from 16 to 16384, such as 1280x720, not \"{}\".",
               option, printable_line(text));
}

/// Options of images, where there are none, would do nothing.
Status check_images_wanted(const ImageOutput& images, const RawOptions& raw) {
  for (const std::string_view option : {"--frames-format", "--size", "--text", "--no-text"})
    if (raw.gave(option) && !images.any())
      return usage("{} applies to images: add --video FILE or --frames DIR, or omit it.", option);
  for (const std::string_view option : {"--fps", "--speed", "--view"})
    if (raw.gave(option) && !images.any() && !images.any_page())
      return usage("{} applies to images: add --video FILE, --frames DIR or --html FILE, or omit it.",
                   option);
  if (raw.gave("--frames-format") && images.frames.empty())
    return usage("--frames-format applies to --frames DIR: add that, or omit --frames-format.");
  return {};
}

Status finish_images(ImageOutput& images, const RawOptions& raw) {
  ASPIC_CHECK(check_images_wanted(images, raw));
  ASPIC_TRY(const auto size, parse_size(raw.size));
  images.size = size;
  const VideoFormat* const frames = find_video_format(raw.frames_format);
  if (!frames || !frames->is_directory())
    return usage("--frames-format must be {}, not \"{}\".", video_endings(true),
                 printable_line(raw.frames_format));
  images.frames_format = frames;
  if (raw.text != "on" && raw.text != "off")
    return usage("--text must be on or off, not \"{}\".", printable_line(raw.text));
  images.text = raw.text == "on" && !raw.no_text;
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (images.fps && !(positive(*images.fps) && *images.fps <= 1000.0))
    return usage("--fps must be more than 0 and at most 1000, not {}.", *images.fps);
  if (!positive(images.speed)) return usage("--speed must be a finite number above 0, not {}.", images.speed);
  const std::pair<std::string_view, const std::string&> pages[] = {{"--html", images.page},
                                                                   {"--html-live", images.page_live}};
  for (const auto& [option, path] : pages)
    if (const Status named = path.empty() ? Status() : page::check_page_name(path); !named)
      return fail(named.error(), "{}: {}", option, named.error().what);
  if (images.video.empty()) return {};
  ASPIC_TRY(const auto format, video_format_of(images.video));
  return check_video(*format, images.size, frames_per_second(images));
}

/// The options that every backend may be asked for.
Result<BackendChoice> asked_of_all(const RawOptions& raw) {
  BackendChoice asked;
  ASPIC_TRY(asked.precision, parse_precision(raw.precision.empty() ? "single" : raw.precision));
  ASPIC_TRY(asked.force_path, parse_force_path(raw.force_path));
  ASPIC_TRY(asked.arithmetic, parse_arithmetic(raw.arithmetic));
  if (raw.threads == 0u) return usage("--threads must be a whole number from 1 to 1024.");
  asked.threads = raw.threads.value_or(0);
  return asked;
}

/// Options given for all backends must be ones that some of them have, if only by their own words.
Status check_choices(const std::vector<BackendChoice>& choices, const BackendChoice& asked) {
  for (const BackendChoice& choice : choices) ASPIC_CHECK(check_choice(choice));
  const auto takes = [&](auto BackendChoice::*option) {
    return asked.*option == BackendChoice{}.*option ||
           std::ranges::any_of(choices, [&](const BackendChoice& c) {
             return choice_for(c.row, asked).*option == asked.*option;
           });
  };
  if (takes(&BackendChoice::precision) && takes(&BackendChoice::force_path) &&
      takes(&BackendChoice::arithmetic) && takes(&BackendChoice::threads))
    return {};
  BackendChoice refused = asked;
  refused.row = choices.front().row;
  return check_choice(refused);
}

/// --backend of a command that takes one, with its options after colons.
Result<BackendChoice> one_backend(const RawOptions& raw) {
  ASPIC_TRY(const auto asked, asked_of_all(raw));
  ASPIC_TRY(const auto choice, parse_backend(raw.backend, asked));
  ASPIC_CHECK(check_choices({choice}, asked));
  return choice;
}

/// "gpu,cpu,reference" where two were wanted.
Status check_two(const std::vector<std::string>& backends) {
  if (backends.size() == 2) return {};
  return usage("--backends takes two backends, such as gpu,reference, not {} ({}).", backends.size(),
               printable_line(fmt::format("{}", fmt::join(backends, ","))));
}

Result<std::vector<BackendChoice>> bench_backends(const RawOptions& raw) {
  ASPIC_TRY(const auto asked, asked_of_all(raw));
  std::vector<BackendChoice> backends;
  for (const std::string& text : raw.bench_backends) {
    ASPIC_TRY(const auto choice, parse_backend(text, asked));
    const bool paths = choice.row && !choice.row->force_paths().empty();
    if (!paths || choice.force_path != ForcePath::automatic || raw.bench_force_paths.empty()) {
      backends.push_back(choice);
      continue;
    }
    for (const std::string& word : raw.bench_force_paths) {
      ASPIC_TRY(const auto path, parse_force_path(word));
      backends.push_back(choice);
      backends.back().force_path = path;
    }
  }
  ASPIC_CHECK(check_choices(backends, asked));
  return backends;
}

}  // namespace

Result<Command> finish_run(RunOptions run, const RawOptions& raw) {
  ASPIC_TRY(run.backend, one_backend(raw));
  run.precision_given = !raw.precision.empty() || raw.backend.find(":single") != std::string::npos ||
                        raw.backend.find(":double") != std::string::npos;
  ASPIC_CHECK(check_length(run.length));
  for (const StateOutput& output : run.outputs) {
    if (!output.every || !output.path.empty()) continue;
    const std::string interval = fmt::format("--{}-every", output.option);
    return usage("{0} applies to --{1} FILE: add that, or omit {0}.",
                 raw.gave(interval) ? interval : "--every", output.option);
  }
  for (const StateOutput& output : run.outputs)
    if (const Status named = check_endings({output}); !named)
      return fail(named.error(), "--{}: {}", output.option, named.error().what);
  if (run.scene.empty() && run.resume_file.empty()) {
    return usage("aspic run needs a SCENE: a file, or a built-in name from aspic scene list.");
  }
  if (run.scene.empty() && !run.overrides.empty()) {
    return usage(
        "--set cannot change the scene of a checkpoint. Omit --set, or run a scene without --resume.");
  }
  ASPIC_CHECK(finish_images(run.images, raw));
  return Command(std::move(run));
}

Result<Command> finish_compare(CompareOptions compare, const RawOptions& raw) {
  ASPIC_CHECK(check_two(raw.backends));
  ASPIC_TRY(const auto asked, asked_of_all(raw));
  ASPIC_TRY(compare.first, parse_backend(raw.backends.front(), asked));
  ASPIC_TRY(compare.second, parse_backend(raw.backends.back(), asked));
  ASPIC_CHECK(check_choices({compare.first, compare.second}, asked));
  ASPIC_CHECK(check_length(compare.length));
  if (!(std::isfinite(compare.tolerance) && compare.tolerance >= 0.0)) {
    return usage("--tolerance must be a finite number, 0 or more, not {}.", compare.tolerance);
  }
  return Command(std::move(compare));
}

Result<Command> finish_view(ViewOptions view, const RawOptions& raw) {
  ASPIC_TRY(view.backend, one_backend(raw));
  if (!raw.window_size.empty()) {
    ASPIC_TRY(view.size, parse_size(raw.window_size));
  }
  view.layout = present_layout(view.layout);
  if (!view.layout.empty() && std::ranges::find(window_layouts, view.layout) == std::end(window_layouts))
    return usage("--layout must be one of {}, not \"{}\".", fmt::join(window_layouts, ", "),
                 printable_line(view.layout));
  return Command(std::move(view));
}

Result<Command> finish_sweep(SweepOptions sweep, const RawOptions& raw) {
  ASPIC_TRY(sweep.backend, one_backend(raw));
  ASPIC_CHECK(check_length(sweep.length));
  if (sweep.out.empty() && sweep.runs.empty())
    return usage("a sweep needs --out FILE.csv for its table, or --runs DIR for its runs, or both.");
  if (const std::string ending = ending_of(sweep.out);
      !ending.empty() && ending != ".csv" && !is_device_or_pipe(sweep.out))
    return usage("--out writes CSV: end its name {} in .csv.", printable_line(sweep.out));
  const char* const end = raw.part.data() + raw.part.size();
  const auto part = std::from_chars(raw.part.data(), end, sweep.part);
  const bool slash = part.ec == std::errc() && part.ptr != end && *part.ptr == '/';
  const auto parts = slash ? std::from_chars(part.ptr + 1, end, sweep.parts) : part;
  if (!slash || parts.ec != std::errc() || parts.ptr != end || sweep.part < 1 || sweep.part > sweep.parts ||
      sweep.parts > 1000000)
    return usage("--part must be i/n with 1 <= i <= n <= 1000000, such as 2/8, not \"{}\".",
                 printable_line(raw.part));
  return Command(std::move(sweep));
}

Result<Command> finish_bench(BenchOptions bench, const RawOptions& raw) {
  ASPIC_TRY(bench.backends, bench_backends(raw));
  for (const std::string& word : raw.bench_integrators) {
    if (word == "all") {
      bench.integrators.assign(std::begin(all_integrators), std::end(all_integrators));
      break;
    }
    const auto known = std::find_if(std::begin(all_integrators), std::end(all_integrators),
                                    [&](Integrator i) { return name_of(i) == word; });
    if (known == std::end(all_integrators)) {
      std::vector<std::string_view> names;
      for (const Integrator i : all_integrators) names.push_back(name_of(i));
      return usage("unknown --integrator \"{}\"; allowed: all, {}.", printable_line(word),
                   fmt::join(names, ", "));
    }
    bench.integrators.push_back(*known);
  }
  if (raw.bench_timestep != "scene" && raw.bench_timestep != "largest") {
    return usage("--timestep must be scene or largest, not \"{}\".", printable_line(raw.bench_timestep));
  }
  bench.timestep = raw.bench_timestep == "largest" ? BenchTimestep::largest : BenchTimestep::scene;
  constexpr double longest = 1e6;  // s: eleven days
  if (!(bench.seconds > 0.0 && bench.seconds <= longest))
    return usage("--seconds must be a number above 0 and at most 1e6.");
  if (bench.duration && !(std::isfinite(*bench.duration) && *bench.duration > 0.0)) {
    return usage("--duration must be a number above 0.");
  }
  if (bench.repeats < 1) return usage("--repeats must be 1 or more.");
  if (!raw.bench_images.empty()) {
    ASPIC_TRY(bench.images, parse_size(raw.bench_images, "--images"));
  }
  return Command(std::move(bench));
}

Result<Command> finish_import(const SceneImportOptions& import) {
  // Keys of a scene with the names that they have here.
  const auto check = [](std::string_view option, std::string_view path, const auto& value) -> Status {
    const Parameter& key = *find_parameter(path);
    const auto wrong = value ? check_value(key, Value(*value)) : std::nullopt;
    if (!wrong) return {};
    const std::string name = fmt::format("'{}'", key_text(key));
    std::string message = wrong->message;
    if (const std::size_t at = message.find(name); at != std::string::npos)
      message.replace(at, name.size(), option);
    return usage("{}.", message);
  };
  ASPIC_CHECK(check("--height", "voxels[].height", import.height));
  ASPIC_CHECK(check("--up", "voxels[].up", import.up));
  ASPIC_CHECK(check("--pieces", "voxels[].pieces", import.pieces));
  return Command(import);
}

}  // namespace aspic
