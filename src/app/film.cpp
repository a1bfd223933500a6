#include "app/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "run/run_files.h"

namespace aspic::app {
namespace {

std::string result_text(Recording& film) {
  const FilmOptions& options = film.options();
  if (const Status result = film.result(); !result) return result.error().message;
  return fmt::format("{} holds {} pictures, {:.2f} s at {:g} per second.", options.path, film.pictures(),
                     film.seconds(), options.fps);
}

/// `path` with the ending that the format wants in place of another format's; directories have none.
std::string film_path(const std::string& path, const FilmFormat& format) {
  std::filesystem::path named(path);
  if (find_film_format(named.extension().string())) named.replace_extension();
  return named.string() + std::string(film_ending(format));
}

}  // namespace

void Film::start() {
  stop();
  if (!editor_.beside().empty())
    return messages_.refuse(
        "The window films one run alone. Leave side by side first, or film all runs with aspic run … "
        "--beside, which draws the same.");
  const FilmFormat& format = *settings.format;
  const auto pixels = [&](double length) {
    const int count = std::max(static_cast<int>(std::lround(length * view_.pixels_per_unit)), 16);
    return format.even_sides ? count & ~1 : count;
  };
  FilmOptions options;
  options.fps = settings.fps;
  options.path = settings.path.empty() ? free_name(editor_.source(), film_ending(format))
                                       : film_path(settings.path, format);
  options.size = {pixels(view_.box.right - view_.box.left), pixels(view_.box.bottom - view_.box.top)};
  std::error_code unknown;
  if (!format.is_directory() && std::filesystem::exists(options.path, unknown))
    return messages_.refuse(
        fmt::format("{} already exists. Choose another name for the film, or none.", options.path));
  if (format.is_directory() && std::filesystem::exists(options.path, unknown) &&
      !std::filesystem::is_empty(options.path, unknown)) {
    return messages_.refuse(
        fmt::format("{} already exists and is not an empty directory. Choose another name for the pictures.",
                    options.path));
  }
  auto sink = open_film(format, options.path, options.size, options.fps, Overwrite::refuse);
  if (!sink) return messages_.error(sink.error().message);
  std::vector<std::unique_ptr<FrameSink>> sinks;
  sinks.push_back(std::move(*sink));
  auto started = Recording::start(picture_.context(), std::move(sinks), std::move(options));
  if (!started) return messages_.error(started.error().message);
  recording_ = std::move(*started);
  pace_.emplace(recording_->options().fps);
  scene_ = editor_.source();
  picture_.film = FilmLook{recording_->options().size, settings.text};
  messages_.info(fmt::format("Recording to {}, in step with simulated time.", recording_->options().path));
  update();
}

void Film::stop() {
  if (!recording_) return;
  // The name is used up: the next film gets another.
  settings.path.clear();
  end();
}

void Film::end() {
  recording_->end();
  completing_.push_back(std::move(recording_));
  pace_.reset();
  simulation_.pacer().pause_step.reset();
  picture_.film.reset();
}

void Film::update() {
  report_completed();
  if (!recording_) return;
  // Nothing but an error completes a film by itself.
  if (recording_->completed()) return end();
  // States passed on the way through history are not filmed; the one it ends at is.
  if (simulation_.seeking()) return;
  const double speed = simulation_.pacer().speed;
  // A job in progress goes to the step that the old speed asked for.
  if (speed != pace_->speed()) messages_.check(simulation_.halt());
  if (scene_ != editor_.source()) pace_->restart();
  scene_ = editor_.source();
  const std::uint64_t copies =
      pace_->take(simulation_.step(), simulation_.model().simulation.timestep, speed);
  Status taken;
  if (copies == 0)
    taken = recording_->progress();
  else if (taken = picture_.draw(); taken)
    taken = recording_->add(picture_.pixels(), copies);
  if (!messages_.check(taken)) return end();
  // While the encoder is behind, the motion waits and the window does not.
  simulation_.pacer().pause_step = recording_->ready() ? pace_->next_step() : simulation_.step();
}

void Film::report_completed() {
  std::erase_if(completing_, [this](const std::unique_ptr<Recording>& film) {
    if (!film->completed()) return false;
    if (film->result())
      messages_.info(result_text(*film));
    else
      messages_.error(result_text(*film) + " The simulation continues without a film.");
    return true;
  });
}

std::vector<std::string> Film::finish() {
  stop();
  std::vector<std::string> lines;
  for (const auto& film : completing_) lines.push_back(result_text(*film));
  completing_.clear();
  return lines;
}

}  // namespace aspic::app
