#include "run/recorder.h"

#include <fmt/format.h>

#include <chrono>
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
  r->context_ = backend.context.get();
  if (!r->context_) {
    auto context = gl::Context::create_headless();
    if (!context)
      return Error{context.error().code,
                   "pictures need an OpenGL device; a software one is enough. " + context.error().message};
    r->own_context_ = std::move(*context);
    r->context_ = r->own_context_.get();
  }
  ASPIC_TRY(const auto directory, shader_directory());
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(directory);
  ASPIC_TRY(r->renderer_, Renderer::create(*r->context_, look));
  ASPIC_CHECK(r->renderer_->set_model(model));
  r->following_ = Following(scene, model, backend.solver->precision());
  FilmOptions film = {sinks.front()->path(), fps, output.size};
  ASPIC_TRY(r->recording_, Recording::start(*r->context_, std::move(sinks), std::move(film)));
  return r;
}

const std::string& Recorder::device() const {
  return context_->info().renderer;
}

FrameTimes Recorder::times() const {
  FrameTimes times = recording_->times();
  times.simulate = simulate_seconds_;
  times.draw = draw_seconds_;
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
  recording_->wait_until_ready();
  // Nothing but an error completes the film before its end.
  if (recording_->completed()) return recording_->result();
  const auto before = std::chrono::steady_clock::now();
  const bool on_device = backend_.gpu && !own_context_;
  State state;
  if (!on_device || following_.any() || scene_.view.arrows.any()) {
    ASPIC_TRY(state, solver.state());
  }
  DeviceState drawn_state;
  if (on_device) {
    drawn_state = backend_.gpu->device_state();
  } else {
    ASPIC_TRY(drawn_state, renderer_->upload(state));
  }
  PictureOptions picture;
  picture.view = scene_.view;
  picture.view.camera = fitted(moved(scene_.view.camera, following_.offset(solver.model(), state)),
                               output_.size.width, output_.size.height);
  picture.legend = output_.text;
  if (picture.view.arrows.any()) picture.arrows = arrows_of(solver.model(), state, picture.view.arrows);
  if (output_.text)
    picture.text =
        overlay_lines(scene_.model, static_cast<double>(step) * solver.model().simulation.timestep);
  ASPIC_CHECK(renderer_->draw(output_.size.width, output_.size.height, drawn_state, picture));
  draw_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  last_shown_ = step;
  return recording_->add(renderer_->picture(), copies);
}

Status Recorder::finish(Solver& solver, std::uint64_t step) {
  if (recording_->pictures() == 0 || last_shown_ != step) {
    if (const Status drawn = draw(solver, step, 1); !drawn) {
      recording_->abandon();
      return drawn;
    }
  }
  ASPIC_CHECK(recording_->end_complete());
  return recording_->result();
}

}  // namespace aspic
