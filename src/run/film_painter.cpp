#include "run/film_painter.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/stopwatch.h"
#include "device/particles.h"
#include "gpu/current.h"

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Result<std::unique_ptr<FilmPainter>> FilmPainter::create(gl::Context& context, const PictureOutput& output,
                                                         std::vector<PaintedRun> runs, std::uint64_t pictures,
                                                         std::vector<std::unique_ptr<FrameSink>> sinks) {
  std::unique_ptr<FilmPainter> f(new FilmPainter(context, output, std::move(runs)));
  if (context.info().is_software) {
    const DrawingWork work = {output.drawer, output.size, f->runs_, pictures};
    ASPIC_TRY(const unsigned count, drawers_for(work));
    if (count > 0) f->drawers_ = Drawers::start(work, context.info().renderer, count);
  }
  if (f->drawers_) {
    f->turned_.resize(f->runs_.size());
    f->processes_ = f->drawers_->count();
  } else {
    ASPIC_TRY([[maybe_unused]] PicturePainter* const made, f->painter());
  }
  FilmOptions film = {sinks.front()->path(), frames_per_second(output), output.size};
  ASPIC_TRY(f->recording_, Recording::start(context, std::move(sinks), std::move(film)));
  return f;
}

FilmPainter::~FilmPainter() = default;

Result<PicturePainter*> FilmPainter::painter() {
  if (!painter_) {
    ASPIC_TRY(painter_, PicturePainter::create(*context_, output_.size, runs_));
  }
  return painter_.get();
}

Result<DeviceState> FilmPainter::uploaded(std::size_t run, const PaintedState& state) {
  if (state.there.particles) return state.there;
  ASPIC_TRY(PicturePainter* const painter, this->painter());
  return upload(painter->renderer(run), *state.solver);
}

FrameTimes FilmPainter::times() const {
  FrameTimes times = recording_->times();
  times.draw = draw_seconds_;
  times.read += read_seconds_;
  times.processes = processes_;
  return times;
}

/// What a process that draws some of the pictures cannot know: how balls have turned in the others.
Status FilmPainter::turn_balls(const std::vector<PaintedState>& states, std::vector<ShownRun>& shown) {
  for (std::size_t i = 0; i < turned_.size(); ++i) {
    if (runs_[i].model->balls.empty()) continue;
    ASPIC_TRY(PicturePainter* const painter, this->painter());
    ASPIC_TRY(const auto state, uploaded(i, states[i]));
    ASPIC_CHECK(painter->renderer(i).turn_balls(state, turned_[i]));
    shown[i].ball_turns = turned_[i].turns;
  }
  return {};
}

Status FilmPainter::add(const std::vector<PaintedState>& states, std::vector<ShownRun> shown,
                        std::uint64_t copies) {
  // Nothing but an error completes the film before its end.
  if (recording_->completed()) return recording_->result();
  ASPIC_CHECK(turn_balls(states, shown));
  if (drawers_ && drawers_->count() > 0) {
    ASPIC_TRY(const bool asked, ask(states, shown, copies));
    if (asked) return {};
  }
  while (!asked_.empty()) ASPIC_CHECK(take_first());
  recording_->wait_until_ready();
  if (recording_->completed()) return recording_->result();
  const auto before = Clock::now();
  std::vector<DeviceState> there;
  for (std::size_t i = 0; i < states.size(); ++i) {
    ASPIC_TRY(const auto state, uploaded(i, states[i]));
    there.push_back(state);
  }
  draw_seconds_ += seconds_since(before);
  return draw_here(there, shown, copies);
}

/// False: no process is left.
Result<bool> FilmPainter::ask(const std::vector<PaintedState>& states, std::vector<ShownRun>& shown,
                              std::uint64_t copies) {
  while (!asked_.empty() && drawers_->answered(asked_.front().place)) ASPIC_CHECK(take_first());
  std::optional<Drawers::Place> place;
  while (!(place = drawers_->free_place())) {
    if (drawers_->count() == 0) return false;
    if (!asked_.empty())
      ASPIC_CHECK(take_first());
    else
      recording_->wait_until([this] { return drawers_->free_place().has_value(); });
    if (!recording_->completed()) continue;
    ASPIC_CHECK(recording_->result());
    return true;
  }
  DrawerRequest request = {place->slot, {}, std::move(shown)};
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    ASPIC_TRY(const std::uint64_t step,
              read_packed(*states[i].solver, drawers_->particles(*place, i), drawers_->balls(*place, i)));
    request.steps.push_back(step);
  }
  drawers_->ask(*place, request);
  asked_.push_back({*place, std::move(request), copies});
  return true;
}

/// The first of the pictures that processes were asked for goes to the encoder.
Status FilmPainter::take_first() {
  const auto drawn = drawers_->take(asked_.front().place);
  if (!drawn) return draw_first_here();
  const Asked first = std::move(asked_.front());
  asked_.pop_front();
  draw_seconds_ += drawn->draw;
  read_seconds_ += drawn->read;
  recording_->add(drawn->rgb, first.copies, drawers_->owner(first.place));
  return {};
}

/// The same where its process was lost.
Status FilmPainter::draw_first_here() {
  const Asked first = std::move(asked_.front());
  asked_.pop_front();
  ASPIC_TRY(PicturePainter* const painter, this->painter());
  std::vector<DeviceState> states;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const auto particles = drawers_->particles(first.place, i);
    const auto balls = drawers_->balls(first.place, i);
    ASPIC_TRY(const auto state,
              painter->renderer(i).upload({particles.begin(), particles.end()}, {balls.begin(), balls.end()},
                                          first.request.steps[i]));
    states.push_back(state);
  }
  ASPIC_CHECK(draw_here(states, first.request.shown, first.copies));
  return recording_->hand_on_all();
}

Status FilmPainter::draw_here(const std::vector<DeviceState>& states, const std::vector<ShownRun>& shown,
                              std::uint64_t copies) {
  const auto before = Clock::now();
  ASPIC_TRY(PicturePainter* const painter, this->painter());
  ASPIC_CHECK(painter->draw(states, shown));
  draw_seconds_ += seconds_since(before);
  return recording_->add(painter->picture(), copies);
}

Status FilmPainter::finish() {
  while (!asked_.empty()) {
    if (const Status taken = take_first(); !taken) {
      abandon();
      return taken;
    }
  }
  if (drawers_) {
    processes_ = drawers_->useful();
    drawers_->end();
  }
  ASPIC_CHECK(recording_->end_complete());
  return recording_->result();
}

void FilmPainter::abandon() {
  recording_->abandon();
  asked_.clear();
  if (drawers_) drawers_->end();
}

}  // namespace aspic
