// The part of App that films.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/app.h"
#include "run/outputs.h"

namespace aspic::app {
namespace {

std::string said_of(Recording& film) {
  const FilmOptions& options = film.options();
  if (const Status result = film.result(); !result) return result.error().message;
  return fmt::format("{} holds {} pictures, {:.2f} s at {:g} a second.", options.path, film.pictures(),
                     film.seconds(), options.fps);
}

}  // namespace

std::string film_path(const std::string& path, const FilmFormat& format) {
  std::filesystem::path named(path);
  if (find_film_format(named.extension().string())) named.replace_extension();
  return named.string() + std::string(film_ending(format));
}

void App::start_recording() {
  stop_recording();
  const auto pixels = [this](double length) {
    return std::max(static_cast<int>(std::lround(length * pixels_per_unit_)), 16);
  };
  const FilmFormat& format = *film_settings_.format;
  FilmOptions options;
  options.fps = film_settings_.fps;
  options.path = film_settings_.path.empty() ? free_name(editor_.source(), film_ending(format))
                                             : film_path(film_settings_.path, format);
  options.size = {pixels(viewport_.right - viewport_.left), pixels(viewport_.bottom - viewport_.top)};
  if (format.even_sides) {
    options.size.width &= ~1;
    options.size.height &= ~1;
  }
  std::error_code unknown;
  if (format.is_directory() && std::filesystem::exists(options.path, unknown) &&
      !std::filesystem::is_empty(options.path, unknown)) {
    return tell(fmt::format("{} exists already and is not an empty directory. Choose another name for the "
                            "pictures.",
                            options.path),
                true);
  }
  auto sink = open_film(format, options.path, options.size, options.fps, Overwrite::refuse);
  if (!sink) return tell(sink.error());
  std::vector<std::unique_ptr<FrameSink>> sinks;
  sinks.push_back(std::move(*sink));
  auto started = Recording::start(*context_, std::move(sinks), std::move(options));
  if (!started) return tell(started.error());
  recording_ = std::move(*started);
  film_pace_.emplace(recording_->options().fps);
  filmed_scene_ = editor_.source();
  drawn_width_ = 0;  // the film's pictures may have text
  tell(fmt::format("Recording to {}, in step with simulated time.", recording_->options().path));
  film();
}

void App::stop_recording() {
  if (!recording_) return;
  // The name is used up: the next film gets another.
  film_settings_.path.clear();
  end_film();
}

void App::toggle_recording() {
  if (recording_)
    stop_recording();
  else
    start_recording();
}

void App::end_film() {
  recording_->end();
  completing_.push_back(std::move(recording_));
  film_pace_.reset();
  simulation_->pause_at(std::nullopt);
  drawn_width_ = 0;
}

void App::film() {
  watch_films();
  if (!recording_) return;
  // Nothing but an error completes a film by itself.
  if (recording_->completed()) return end_film();
  // States on the way through history are nobody's business; where it ends is shown, and filmed.
  if (simulation_->seeking()) return;
  // A job under way goes to the step that the old speed asked for.
  if (simulation_->speed != film_pace_->speed()) tell(simulation_->settle());
  if (filmed_scene_ != editor_.source()) film_pace_->begin_anew();
  filmed_scene_ = editor_.source();
  const std::uint64_t pictures =
      film_pace_->take(simulation_->step(), simulation_->model().simulation.timestep, simulation_->speed);
  Status taken;
  if (pictures > 0) {
    taken = draw_picture(recording_->options().size.width, recording_->options().size.height);
    if (taken) taken = recording_->add(renderer_->picture(), pictures);
  } else {
    taken = recording_->progress();
  }
  if (!taken) {
    tell(taken);
    return end_film();
  }
  // While the encoder is behind, the motion waits and the window does not.
  simulation_->pause_at(recording_->ready() ? film_pace_->next_step() : simulation_->step());
}

void App::watch_films() {
  std::erase_if(completing_, [this](const std::unique_ptr<Recording>& film) {
    if (!film->completed()) return false;
    const bool failed = !film->result();
    tell(said_of(*film) + (failed ? " The simulation goes on without a film." : ""), failed);
    return true;
  });
}

std::vector<std::string> App::finish_films() {
  stop_recording();
  std::vector<std::string> lines;
  for (const auto& film : completing_) lines.push_back(said_of(*film));
  completing_.clear();
  return lines;
}

}  // namespace aspic::app
