// The section that records videos and states.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "app/number_field.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "aspic/scene.h"
#include "io/atomic_file.h"
#include "io/series_csv.h"
#include "io/state_sink.h"
#include "playback/recorded_inputs.h"
#include "run/run_files.h"
#include "variants/comparison.h"

namespace aspic::app {
namespace {

constexpr const char* start_or_end = "start or end a video";

void format_widget(Gui& gui, VideoSettings& video) {
  label_column("Format");
  std::vector<std::string_view> names, labels;
  for (const VideoFormat& format : video_formats()) {
    names.push_back(format.name);
    labels.push_back(format.label);
  }
  auto index = static_cast<std::size_t>(video.format - video_formats().data());
  if (!choice(gui, "record/format", names, labels, index,
              "Selects a file or a directory of frames. mp4, webm and GIF need ffmpeg."))
    return;
  video.format = &video_formats()[index];
  video.fps = std::min(video.fps, video.format->most_fps);
}

void rate_widget(Gui& gui, VideoSettings& video) {
  label_column("Images");
  const double least = 1.0, most = video.format->most_fps;
  number_drag("##fps", video.fps, 0.2f, least, most, "%.4g a second", ImGuiSliderFlags_AlwaysClamp,
              between(least, most));
  named(
      gui, "record/fps",
      fmt::format("Sets the frames per second, 1 … {:g} in this format.\nDrag to change, Ctrl+click to type.",
                  most));
}

void name_widget(Gui& gui, const std::string& source, VideoSettings& video) {
  label_column("Name");
  std::array<char, 1024> text = {};
  video.path.copy(text.data(), text.size() - 1);
  const std::string hint = free_name(source, video_ending(*video.format));
  const float room = ImGui::CalcItemWidth() - 2.0f * ImGui::GetStyle().FramePadding.x;
  if (ImGui::InputTextWithHint("##video", elided_path(hint, room).c_str(), text.data(), text.size()))
    video.path = text.data();
  named(gui, "record/path",
        fmt::format("Names the video; if empty, {}. The format sets the extension.", hint));
}

/// Whether the video's states are written too, and in which format.
void states_widget(Gui& gui, VideoSettings& video) {
  label_column("States");
  std::vector<const StateFormat*> formats = {nullptr};
  std::vector<std::string_view> names = {"none"}, labels = {"none"};
  std::string help = "Writes the states of the frames too, as aspic run --export does.";
  for (const StateFormat& format : state_formats()) {
    if (!format.motion) continue;
    formats.push_back(&format);
    names.push_back(format.ending);
    labels.push_back(format.label);
    help += fmt::format("\n{}: {}.", format.ending, format.label);
  }
  auto index = static_cast<std::size_t>(std::ranges::find(formats, video.states) - formats.begin());
  if (choice(gui, "record/states", names, labels, index,
             help + "\nEnds when the model changes or the run is rewound."))
    video.states = formats[index];
}

/// The energies of the plot as a table.
Status write_series(const std::string& path, Overwrite overwrite, const std::deque<EnergySample>& samples) {
  ASPIC_TRY(auto series, SeriesWriter::create(path, overwrite));
  for (const EnergySample& sample : samples) {
    ASPIC_CHECK(series.add(sample.step, sample.time, sample.measures, {}, sample.work));
  }
  return series.finish();
}

/// `replayed`: the log whose inputs the run has in addition to those of hands.
Status write_state(const StateFormat& format, const std::string& path, Overwrite overwrite, Scene scene,
                   const PlaybackSession& simulation, const State& state, const InputLog& replayed) {
  scene.model = simulation.present().setup().settings;
  RunFacts facts = {to_toml(scene), scene.model.simulation.integrator};
  if (format.holds_scene) {
    ASPIC_TRY(const InputLog inputs,
              inputs_to_go_on(simulation.playback().history(), simulation.playback().here(), replayed));
    if (!inputs.empty()) facts.inputs_toml = to_toml(inputs, scene.model.simulation.timestep);
  }
  ASPIC_TRY(auto sink, format.open(path, 0, overwrite, facts));
  return sink->finish({simulation.model(), state});
}

/// A name that nothing has yet, of several runs none of their numbered ones either.
std::string free_state_name(const std::string& source, std::string_view ending,
                            const Comparison& comparison) {
  if (!comparison.active()) return free_name(source, ending);
  const std::string number = "-1", first = free_name(source, number + std::string(ending));
  return first.substr(0, first.size() - ending.size() - number.size()) + std::string(ending);
}

/// Writes the state now, or with a format over time the energies of the plot, to a file; of runs compared
/// each to its own, numbered as aspic run --variant does. A message says what became of it.
void save(const StateFormat& format, const std::string& path, Overwrite overwrite,
          PlaybackSession& simulation, ComparisonView& comparison_view, Messages& messages) {
  const Comparison& comparison = comparison_view.comparison();
  if (!messages.check(simulation.settle())) return;
  std::vector<std::string> paths, lines;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    paths.push_back(comparison.active() ? numbered_path(path, i + 1) : path);
    std::error_code unknown;
    if (comparison.active() && overwrite == Overwrite::refuse && std::filesystem::exists(paths[i], unknown))
      return messages.refuse(fmt::format("{} already exists. Choose another name.", paths[i]));
    if (format.holds_scene && !comparison.run(i).present().setup().thrown.empty())
      return messages.refuse(
          fmt::format("A {} cannot store balls thrown with the mouse. Remove them first (Balls, or Reset), "
                      "or save the state alone.",
                      format.option));
  }
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    const PlaybackSession& run = comparison.run(i);
    const auto& energies = run.samples().energies();
    // Of several runs what the images show, which is of one time.
    const State& state = comparison.active() ? comparison_view.image(i).shown_state() : run.snapshot();
    const Status written = format.over_time
                               ? write_series(paths[i], overwrite, energies)
                               : write_state(format, paths[i], overwrite, comparison.scene(i), run, state,
                                             i == 0 ? simulation.stepper().log() : InputLog());
    if (!written) {
      // Those before it are there.
      lines.insert(lines.begin(), worded(written.error(), FrontEnd::window));
      return messages.error(fmt::format("{}", fmt::join(lines, "\n")));
    }
    lines.push_back(format.over_time
                        ? fmt::format("{} holds {} rows.", paths[i], energies.size())
                        : fmt::format("{} holds the {} at step {}.", paths[i], format.option, state.step));
  }
  messages.info(fmt::format("{}", fmt::join(lines, "\n")));
}

/// Writes what hands did so far. A message says what became of it.
void save_inputs(const std::string& path, Overwrite overwrite, PlaybackSession& simulation,
                 Messages& messages) {
  if (!messages.check(simulation.settle())) return;
  const auto inputs = recorded_inputs(simulation.playback().history(), simulation.playback().here());
  if (!inputs) return messages.refuse(inputs.error());
  const auto write = [&]() -> Status {
    ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
    ASPIC_CHECK(file.write(to_toml(*inputs, simulation.model().simulation.timestep)));
    return file.commit();
  };
  if (const Status written = write(); !written) return messages.error(written.error());
  messages.info(fmt::format(
      "{} holds the inputs up to step {}. Open… repeats them here, aspic run --replay without a window.",
      path, simulation.step()));
}

}  // namespace

void recording_section(Gui& gui, const std::string& source, Video& video) {
  if (const Recording* const recording = video.recording()) {
    const VideoOptions& o = recording->options();
    const std::string label = fmt::format("End the video ({:.2f} s)", recording->seconds());
    if (command_button(gui, "record/stop", label.c_str(), "Completes " + o.path + ".", start_or_end, true,
                       -1.0f))
      return;
    ImGui::TextDisabled("%llu frames of %d × %d", static_cast<unsigned long long>(recording->frames()),
                        o.size.width, o.size.height);
    tooltip("Shows the number of frames and their size in pixels.");
    if (!recording->ready()) ImGui::TextDisabled("The motion waits for the encoder.");
    return;
  }
  command_button(gui, "record/start", "Start a video",
                 "Records all runs in simulated time, at the view's present size.", start_or_end, true,
                 -1.0f);
  format_widget(gui, video.settings);
  rate_widget(gui, video.settings);
  name_widget(gui, source, video.settings);
  label_column("Parameters");
  check_box(gui, "shown", "record/text", video.settings.text,
            "Shows terrain, integrator, time step, springs, time and the color legend.");
  label_column("Page");
  check_box(gui, "for browsers", "record/page", video.settings.page,
            "Writes one HTML file for browsers. Changes of the model and rewinding end it.");
  label_column("Live page");
  check_box(gui, "simulates", "record/live", video.settings.live,
            "Writes a page that simulates in the browser and compares bits. Pulls end it.");
  states_widget(gui, video.settings);
  if (video.completing() > 0) ImGui::TextDisabled("Completing the last video …");
}

void image_files(Gui& gui, SavedLook& look) {
  static constexpr std::string_view names[] = {"1", "2", "4"}, labels[] = {"as the view", "×2", "×4"};
  command_button(gui, "image/save", "Save the image", "Saves the image without panels, at full quality.",
                 "save the image", true, -1.0f);
  label_column("Size");
  choice(gui, "image/size", names, labels, look.scale,
         "Sets the pixels of saved images per pixel of the view.");
  label_column("Background");
  check_box(gui, "clear", "image/clear", look.clear, "Makes sky and terrain transparent in saved images.");
}

void state_files(Gui& gui, const std::string& source, PlaybackSession& simulation,
                 ComparisonView& comparison_view, Messages& messages, FileDialog& files) {
  const Comparison& comparison = comparison_view.comparison();
  for (const StateFormat& format : state_formats()) {
    if (format.motion) continue;  // next to videos
    const std::string name = fmt::format("save/{}{}", format.option, format.ending);
    const std::string label = fmt::format("Save {}… ({})", format.option, format.ending);
    std::string help = format.over_time ? "Writes the plotted energies and momentum, a row for each point."
                                        : fmt::format("Writes the {} at this step to a file.", format.option);
    if (comparison.active())
      help += fmt::format(" Each run has its own: name-1{0}, name-2{0} and so on.", format.ending);
    if (!button(gui, name.c_str(), label.c_str(), help, true, -1.0f)) continue;
    // The page outlives this image.
    const auto write = [&format, &simulation, &comparison_view, &messages](const std::string& path,
                                                                           Overwrite overwrite) {
      save(format, path, overwrite, simulation, comparison_view, messages);
    };
    files.ask({"Save", {format.ending}, true, write}, free_state_name(source, format.ending, comparison));
  }
  if (!button(gui, "save/inputs.toml", "Save inputs… (.toml)",
              "Writes pulls and pins by step. Open or aspic run --replay repeats them.", true, -1.0f))
    return;
  const auto write = [&simulation, &messages](const std::string& path, Overwrite overwrite) {
    save_inputs(path, overwrite, simulation, messages);
  };
  const std::string name = free_name(source, "-inputs.toml");
  files.ask({"Save", {".toml"}, true, write}, name);
}

}  // namespace aspic::app
