#include "run/recorder.h"

#include <fmt/format.h>

#include <limits>

#include "render/camera.h"
#include "render/overlay_text.h"
#include "run/arrows.h"

namespace aspic {
namespace {

/// Half a year at 60 pictures a second: more cannot have been meant.
constexpr std::uint64_t most_pictures = 1000000000;

}  // namespace

Status check_pictures(const PictureOutput& output, double timestep, std::uint64_t first_step,
                      std::uint64_t last_step) {
  if (!output.any()) return {};
  const double fps = frames_per_second(output);
  if (FrameSchedule(timestep, first_step, last_step, fps, output.speed).count() <= most_pictures) return {};
  return fail(
      ErrorCode::usage,
      "--speed {} and --fps {} make more than {} pictures of this run: choose a larger speed or fewer "
      "pictures per second.",
      output.speed, fps, most_pictures);
}

Recorder::Recorder(const PictureOutput& output, const Scene& scene, const Backend& backend,
                   const FrameSchedule& schedule)
    : output_(output), scene_(scene), backend_(backend), schedule_(schedule) {}

Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::create(const PictureOutput& output, const Scene& scene,
                                                   const Backend& backend,
                                                   std::vector<std::unique_ptr<FrameSink>> sinks,
                                                   std::uint64_t first_step, std::uint64_t last_step) {
  const Model& model = backend.solver->model();
  const double fps = frames_per_second(output);
  ASPIC_CHECK(check_pictures(output, model.simulation.timestep, first_step, last_step));
  const FrameSchedule schedule(model.simulation.timestep, first_step, last_step, fps, output.speed);
  std::unique_ptr<Recorder> r(new Recorder(output, scene, backend, schedule));
  if (!backend.context) {
    auto context = gl::Context::create_headless();
    if (!context)
      return Error{context.error().code,
                   "pictures need an OpenGL device; a software one is enough. " + context.error().message};
    r->own_context_ = std::move(*context);
  }
  gl::Context& context = backend.context ? *backend.context : *r->own_context_;
  r->following_ = Following(scene, model, backend.solver->precision());
  ASPIC_TRY(r->film_,
            FilmPainter::create(context, output, {{&scene, &model}}, schedule.count(), std::move(sinks)));
  return r;
}

FrameTimes Recorder::times() const {
  FrameTimes times = film_->times();
  times.simulate = simulate_seconds_;
  return times;
}

std::uint64_t Recorder::next_step() const {
  return next_frame_ < schedule_.count() ? schedule_.step_of(next_frame_)
                                         : std::numeric_limits<std::uint64_t>::max();
}

Status Recorder::reach(Solver& solver, std::uint64_t step) {
  std::uint64_t copies = 0;
  for (; next_step() == step; ++next_frame_) ++copies;
  return copies > 0 ? draw(solver, step, copies) : Status();
}

Status Recorder::draw(Solver& solver, std::uint64_t step, std::uint64_t copies) {
  const ViewSettings& view = scene_.view;
  const bool on_device = backend_.gpu && !own_context_;
  State copy;
  PaintedState state;
  if (!on_device || film_->wants_copies() || following_.any() || view.arrows.any()) {
    ASPIC_TRY(copy, solver.state());
  }
  if (on_device && !film_->wants_copies())
    state.there = backend_.gpu->device_state();
  else
    state.copy = &copy;
  ShownRun shown;
  shown.camera = fitted(moved(view.camera, following_.offset(solver.model(), copy)), output_.size.width,
                        output_.size.height);
  shown.legend = output_.text;
  if (view.arrows.any()) shown.arrows = arrows_of(solver.model(), copy, view.arrows);
  if (output_.text)
    shown.text = overlay_lines(scene_, static_cast<double>(step) * solver.model().simulation.timestep);
  ASPIC_CHECK(film_->add({state}, {std::move(shown)}, copies));
  last_shown_ = step;
  return {};
}

Status Recorder::finish(Solver& solver, std::uint64_t step) {
  if (last_shown_ != step) {
    if (const Status drawn = draw(solver, step, 1); !drawn) {
      film_->abandon();
      return drawn;
    }
  }
  return film_->finish();
}

}  // namespace aspic
