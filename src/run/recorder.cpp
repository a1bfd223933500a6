#include "run/recorder.h"

#include <fmt/format.h>

#include <limits>

#include "base/result.h"
#include "io/frame_schedule.h"
#include "model/reading.h"
#include "render/run_view.h"
#include "run/run_files.h"
#include "run/video_painter.h"
#include "run/window_host.h"

namespace aspic {
namespace {

/// Half a year at 60 frames a second: more cannot have been meant.
constexpr std::uint64_t most_frames = 1000000000;

}  // namespace

Result<FrameContext> frame_context(const Backend& backend) {
  if (gl::Context* const there = context_of(backend)) return FrameContext{there, nullptr};
  auto context = gl::Context::create_headless();
  if (!context)
    return fail(context.error(), "images and videos need an OpenGL device, hardware or software. {}",
                context.error().what);
  gl::Context* const own = context->get();
  return FrameContext{own, std::move(*context)};
}

Status check_frame_count(const ImageOutput& output, double timestep, std::uint64_t first_step,
                         std::uint64_t last_step) {
  if (!output.any() && !output.any_page()) return {};
  const double fps = frames_per_second(output);
  if (FrameSchedule(timestep, first_step, last_step, fps, output.speed).count() <= most_frames) return {};
  // With the most frames, each of them takes this many seconds, and a little for rounding below.
  const double each =
      1.01 * static_cast<double>(last_step - first_step) * timestep / static_cast<double>(most_frames);
  return advised(
      fail(ErrorCode::usage, "speed {} and {} frames per second make more than {} frames of this run.",
           output.speed, fps, most_frames),
      {{RemedyKind::raise_speed, {fmt::format("{:.3g}", fps * each)}},
       {RemedyKind::lower_fps, {fmt::format("{:.3g}", output.speed / each)}}});
}

struct Recorder::Parts {
  ImageOutput output;
  const Scene& scene;
  const Backend& backend;
  FrameSchedule schedule;
  Following following = {};
  std::uint64_t next_frame = 0;
  std::optional<std::uint64_t> last_shown = {};
  double simulate_seconds = 0.0;
  std::shared_ptr<gl::Context> own_context = nullptr;
  std::unique_ptr<VideoPainter> video = nullptr;
  State copy = {};  // where the view needs one
};

Recorder::Recorder(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Recorder::~Recorder() = default;

void Recorder::abandon() {
  parts_->video->abandon();
}

std::vector<Error> Recorder::failures() const {
  return parts_->video->recording().failures();
}

std::vector<std::string> Recorder::written() {
  return parts_->video->recording().written();
}

void Recorder::add_simulation(double seconds) {
  parts_->simulate_seconds += seconds;
}

const std::string& Recorder::device() const {
  return parts_->video->device();
}

Result<std::unique_ptr<Recorder>> Recorder::create(const ImageOutput& output, const Scene& scene,
                                                   const Backend& backend,
                                                   std::vector<std::unique_ptr<FrameSink>> sinks,
                                                   std::uint64_t first_step, std::uint64_t last_step) {
  const Model& model = backend.solver->model();
  const double fps = frames_per_second(output);
  ASPIC_CHECK(check_frame_count(output, model.simulation.timestep, first_step, last_step));
  const FrameSchedule schedule(model.simulation.timestep, first_step, last_step, fps, output.speed);
  auto parts = std::make_unique<Parts>(Parts{output, scene, backend, schedule});
  ASPIC_TRY(const FrameContext made, frame_context(backend));
  parts->own_context = made.own;
  parts->following = Following(scene, model, backend.solver->precision());
  ASPIC_TRY(parts->video, VideoPainter::create(*made.context, output, {{&scene, &model}}, std::move(sinks)));
  return std::unique_ptr<Recorder>(new Recorder(std::move(parts)));
}

FrameTimes Recorder::times() const {
  FrameTimes times = parts_->video->times();
  times.simulate = parts_->simulate_seconds;
  return times;
}

std::uint64_t Recorder::next_step() const {
  return parts_->next_frame < parts_->schedule.count() ? parts_->schedule.step_of(parts_->next_frame)
                                                       : std::numeric_limits<std::uint64_t>::max();
}

Status Recorder::reach(Solver& solver, std::uint64_t step) {
  std::uint64_t copies = 0;
  for (; next_step() == step; ++parts_->next_frame) ++copies;
  return copies > 0 ? draw(solver, step, copies) : Status();
}

Status Recorder::draw(Solver& solver, std::uint64_t step, std::uint64_t copies) {
  const GpuSolver* const gpu = gpu_of(parts_->backend);
  State& copy = parts_->copy;
  if (needs_copy(parts_->scene, parts_->following)) ASPIC_CHECK(read_state(solver, copy));
  RunView shown = run_view(parts_->scene, parts_->following, solver, step, copy,
                           {parts_->output.size, parts_->output.text});
  const RenderedState state = {&solver, gpu ? gpu->device_state() : DeviceState()};
  ASPIC_CHECK(parts_->video->add({state}, {std::move(shown)}, copies));
  parts_->last_shown = step;
  return {};
}

Status Recorder::finish(Solver& solver, std::uint64_t step) {
  if (parts_->last_shown != step) {
    if (const Status drawn = draw(solver, step, 1); !drawn) {
      parts_->video->abandon();
      return drawn;
    }
  }
  return parts_->video->finish();
}

}  // namespace aspic
