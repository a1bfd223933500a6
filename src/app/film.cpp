#include "app/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/quantity.h"
#include "run/beside.h"
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
  const FilmFormat& format = *settings.format;
  const auto pixels = [&](double length) {
    const int count = std::max(static_cast<int>(std::lround(length * view_.pixels_per_unit)), 16);
    return format.even_sides ? count & ~1 : count;
  };
  FilmOptions options;
  options.fps = settings.fps;
  options.path = settings.path.empty() ? free_name(editor_.source(), film_ending(format))
                                       : film_path(settings.path, format);
  const Box& all = view_.whole;
  options.size = {pixels(all.right - all.left), pixels(all.bottom - all.top)};
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
  taken_.reset();
  messages_.info(fmt::format("Recording to {}, in step with simulated time.", recording_->options().path));
  take();
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
  for (const Hold hold : {Hold::film, Hold::encoder}) beside_.limit(hold, std::nullopt);
  for (std::size_t i = 0; i < beside_.count(); ++i) beside_.picture(i).film.reset();
  canvas_.reset();
}

/// What the picture of a run is like: as aspic run draws it, alone or with --beside.
FilmLook Film::look_of(std::size_t run) const {
  const PictureSize& size = recording_->options().size;
  if (!beside_.active()) return {size, settings.text};
  const Tile tile = tiles_of(size, beside_.count())[run];
  FilmLook look = {{tile.width, tile.height}, settings.text};
  look.text_height = beside_text_height(size.height, beside_.count());
  look.label = beside_text(beside_.name(run), run, beside_.shown_time(run),
                           beside_.run(run).model().simulation.timestep, beside_.shown_divergence(run));
  if (run == 0) look.label = below_author(beside_.scene(0), std::move(look.label));
  // One legend for all that share a scale.
  const ViewSettings &own = beside_.scene(run).view, &last = beside_.scene(beside_.count() - 1).view;
  look.legend = run + 1 == beside_.count() || own.scale != last.scale || own.colour != last.colour ||
                (own.arrows.any() && !own.arrow_scale);
  return look;
}

/// The picture of all runs, as they are shown.
Status Film::draw() {
  for (std::size_t i = 0; i < beside_.count(); ++i) beside_.picture(i).film = look_of(i);
  beside_.share_colours();
  if (!beside_.active()) {
    canvas_.reset();
    return picture_.draw();
  }
  if (!canvas_) {
    ASPIC_TRY(canvas_, BesideCanvas::create(picture_.context(), recording_->options().size));
  }
  canvas_->divide(beside_.count());
  for (std::size_t i = 0; i < beside_.count(); ++i) {
    ASPIC_CHECK(beside_.picture(i).draw());
    canvas_->place(i, beside_.picture(i).pixels(), settings.text);
  }
  return {};
}

/// How many pictures the film wants of what is shown; none before all runs have come to the clock's step.
std::uint64_t Film::wanted_copies() {
  const Simulation& clock = beside_.clock();
  if (!beside_.shows_clock()) return 0;
  const double timestep = clock.model().simulation.timestep;
  const std::uint64_t copies = pace_->take(clock.step(), timestep, simulation_.pacer().speed());
  if (copies > 0) taken_ = clock.step();
  return copies;
}

void Film::update() {
  report_completed();
  take();
}

void Film::take() {
  if (!recording_) return;
  // Nothing but an error completes a film by itself.
  if (recording_->completed()) return end();
  // States passed on the way through history are not filmed; the one it ends at is.
  if (simulation_.playback().seeking() || beside_.clock().playback().seeking()) return;
  // A job in progress goes to the step that the old speed asked for.
  if (simulation_.pacer().speed() != pace_->speed()) messages_.check(simulation_.halt());
  if (scene_ != editor_.source()) pace_->restart();
  scene_ = editor_.source();
  const std::uint64_t copies = wanted_copies();
  Status taken;
  if (copies == 0)
    taken = recording_->progress();
  else if (taken = draw(); taken)
    taken = recording_->add(drawn(), copies);
  if (!messages_.check(taken)) return end();
  // While the encoder is behind, the motion waits and the window does not. So it does where the run was put
  // to another state, until that is shown.
  const std::uint64_t step = beside_.clock().step();
  const bool on_the_way = taken_ && *taken_ <= step && step <= pace_->next_step();
  beside_.limit(Hold::film, on_the_way ? pace_->next_step() : step);
  beside_.limit(Hold::encoder, recording_->ready() ? std::nullopt : std::optional(step));
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
