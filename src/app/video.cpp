#include "app/video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/quantity.h"
#include "render/tiles.h"
#include "run/run_files.h"

namespace aspic::app {
namespace {

std::string result_text(Recording& video) {
  const VideoOptions& options = video.options();
  if (const Status result = video.result(); !result) return worded(result.error(), FrontEnd::window);
  return fmt::format("{} holds {} frames, {:.2f} s at {:g} per second.", options.path, video.frames(),
                     video.seconds(), options.fps);
}

/// `path` with the ending that the format wants in place of another format's; directories have none.
std::string video_path(const std::string& path, const VideoFormat& format) {
  std::filesystem::path named(path);
  if (find_video_format(named.extension().string())) named.replace_extension();
  return named.string() + std::string(video_ending(format));
}

}  // namespace

void Video::start() {
  stop();
  const VideoFormat& format = *settings.format;
  const auto pixels = [&](double length) {
    const int count = std::max(static_cast<int>(std::lround(length * view_.pixels_per_unit)), 16);
    return format.even_sides ? count & ~1 : count;
  };
  named_ = settings.path;
  VideoOptions options;
  options.fps = settings.fps;
  options.path = settings.path.empty() ? free_name(editor_.source(), video_ending(format))
                                       : video_path(settings.path, format);
  const Box& all = view_.whole;
  options.size = {pixels(all.right - all.left), pixels(all.bottom - all.top)};
  std::error_code unknown;
  if (!format.is_directory() && std::filesystem::exists(options.path, unknown))
    return messages_.refuse(
        fmt::format("{} already exists. Choose another name for the video, or none.", options.path));
  if (format.is_directory() && std::filesystem::exists(options.path, unknown) &&
      !std::filesystem::is_empty(options.path, unknown)) {
    return messages_.refuse(
        fmt::format("{} already exists and is not an empty directory. Choose another name for the frames.",
                    options.path));
  }
  auto sink = open_video(format, options.path, options.size, options.fps, Overwrite::refuse);
  if (!sink) return messages_.error(sink.error());
  std::vector<std::unique_ptr<FrameSink>> sinks;
  sinks.push_back(std::move(*sink));
  auto started = Recording::start(image_.context(), std::move(sinks), std::move(options));
  if (!started) return messages_.error(started.error());
  recording_ = std::move(*started);
  pace_.emplace(recording_->options().fps);
  scene_ = editor_.source();
  taken_.reset();
  start_files();
  messages_.info(fmt::format("Recording to {}, in step with simulated time.", recording_->options().path));
  take();
}

void Video::stop() {
  if (!recording_) return;
  // The name is used up: the next video gets another, or the one that was typed since.
  if (settings.path == named_) settings.path.clear();
  end();
}

/// Next to the video, of its name. The video goes on where there can be none.
void Video::start_files() {
  files_.clear();
  std::filesystem::path named(recording_->options().path);
  if (find_video_format(named.extension().string())) named.replace_extension();
  for (const bool live : {false, true}) {
    if (!(live ? settings.live : settings.page)) continue;
    keep(start_video_page(
             named.string() + (live ? "-live.html" : ".html"), comparison_view_,
             {.fps = recording_->options().fps, .speed = simulation_.pacer().speed(), .live = live}),
         "this page");
  }
  if (settings.states)
    keep(start_video_states(named.string() + std::string(settings.states->ending), *settings.states,
                            comparison_),
         "states");
}

void Video::keep(Result<std::unique_ptr<VideoFile>> file, std::string_view without) {
  if (file) return files_.push_back(std::move(*file));
  messages_.error(
      fmt::format("{} The video continues without {}.", worded(file.error(), FrontEnd::window), without));
}

/// The states of the image that was drawn.
Status Video::add_to_files() {
  if (files_.empty()) return {};
  // A backend in the context hands its state over when it is asked.
  if (!comparison_.active() && simulation_.present().device_state())
    ASPIC_CHECK(simulation_.refresh_snapshot());
  for (const auto& file : files_) file->add(comparison_view_);
  end_files(false);
  return {};
}

/// Tells what became of those that are complete; `all`: completes the others first.
void Video::end_files(bool all) {
  std::erase_if(files_, [&](const std::unique_ptr<VideoFile>& file) {
    if (all) file->finish();
    if (!file->complete()) return false;
    if (file->failed())
      messages_.error(file->said());
    else
      messages_.info(file->said());
    return true;
  });
}

void Video::end() {
  end_files(true);
  recording_->end();
  completing_.push_back(std::move(recording_));
  pace_.reset();
  for (const Hold hold : {Hold::video, Hold::encoder}) comparison_.clock().limit(hold, std::nullopt);
  for (std::size_t i = 0; i < comparison_.count(); ++i) comparison_view_.image(i).video.reset();
  canvas_.reset();
}

/// Options of a run's image: those of aspic run, alone or with --variant. Several runs always have their
/// names.
VideoLook Video::look_of(std::size_t run) const {
  const ImageSize& size = recording_->options().size;
  if (!comparison_.active()) return {size, settings.text};
  const Tile tile = tiles_of(size, comparison_.count())[run];
  VideoLook look = {{tile.width, tile.height}, true};
  look.text_height = comparison_text_height(size.height, comparison_.count());
  look.label =
      comparison_text(comparison_view_.name(run), run, comparison_.shown_time(run),
                      comparison_.run(run).model().simulation.timestep, comparison_.shown_divergence(run));
  if (settings.text && run == 0) look.label = below_author(comparison_.scene(0), std::move(look.label));
  // One legend for all that share a scale.
  const ViewSettings &own = comparison_.scene(run).view,
                     &last = comparison_.scene(comparison_.count() - 1).view;
  look.legend = settings.text && (run + 1 == comparison_.count() || own.scale != last.scale ||
                                  own.color != last.color || (own.arrows.any() && !own.arrow_scale));
  return look;
}

/// The image of all runs, as they are shown.
Status Video::draw() {
  for (std::size_t i = 0; i < comparison_.count(); ++i) comparison_view_.image(i).video = look_of(i);
  comparison_view_.share_colors();
  if (!comparison_.active()) {
    canvas_.reset();
    return image_.draw();
  }
  if (!canvas_) {
    ASPIC_TRY(canvas_, ComparisonCanvas::create(image_.context(), recording_->options().size));
  }
  canvas_->divide(comparison_.count());
  for (std::size_t i = 0; i < comparison_.count(); ++i) {
    ASPIC_CHECK(comparison_view_.image(i).draw());
    canvas_->place(i, comparison_view_.image(i).pixels(), true);
  }
  return {};
}

/// How many images the video wants of what is shown; none before all runs have come to the clock's step.
std::uint64_t Video::wanted_copies() {
  const PlaybackSession& clock = comparison_.clock().setter();
  if (!comparison_.clock().is_shown()) return 0;
  const double timestep = clock.model().simulation.timestep;
  const std::uint64_t copies = pace_->take(clock.step(), timestep, simulation_.pacer().speed());
  if (copies > 0) taken_ = clock.step();
  return copies;
}

void Video::update() {
  report_completed();
  take();
}

void Video::lead() {
  if (!recording_) return;
  if (!recording_->completed() && !messages_.check(recording_->progress())) return end();
  ComparisonClock& clock = comparison_.clock();
  clock.limit(Hold::encoder, recording_->ready() ? std::nullopt : std::optional(clock.setter().step()));
}

void Video::take() {
  if (!recording_) return;
  // Nothing but an error completes a video by itself.
  if (recording_->completed()) return end();
  // States passed on the way through history are not recorded; the one it ends at is.
  if (simulation_.playback().seeking() || comparison_.clock().setter().playback().seeking()) return;
  // A job in progress goes to the step that the old speed asked for.
  if (simulation_.pacer().speed() != pace_->speed()) messages_.check(simulation_.halt());
  if (scene_ != editor_.source()) pace_->restart();
  scene_ = editor_.source();
  const std::uint64_t copies = wanted_copies();
  if (copies > 0) {
    Status taken = draw();
    if (taken) taken = recording_->add(drawn(), copies);
    if (taken) taken = add_to_files();
    if (!messages_.check(taken)) return end();
  }
  // Where the run was put to another state it waits until that is shown.
  const std::uint64_t step = comparison_.clock().setter().step();
  const bool on_the_way = taken_ && *taken_ <= step && step <= pace_->next_step();
  comparison_.clock().limit(Hold::video, on_the_way ? pace_->next_step() : step);
}

void Video::report_completed() {
  std::erase_if(completing_, [this](const std::unique_ptr<Recording>& video) {
    if (!video->completed()) return false;
    if (video->result())
      messages_.info(result_text(*video));
    else
      messages_.error(result_text(*video) + " The simulation continues without a video.");
    return true;
  });
}

std::vector<std::string> Video::finish() {
  stop();
  std::vector<std::string> lines;
  for (const auto& video : completing_) lines.push_back(result_text(*video));
  completing_.clear();
  return lines;
}

}  // namespace aspic::app
