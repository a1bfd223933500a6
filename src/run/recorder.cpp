#include "run/recorder.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "io/video_file.h"
#include "render/overlay_text.h"

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time until its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

double frames_per_second(const RecordingOptions& options) {
  if (options.fps) return *options.fps;
  if (options.video.empty()) return default_fps(VideoFormat::mp4);
  const auto format = video_format_of(options.video);
  return default_fps(format ? *format : VideoFormat::mp4);
}

Recorder::Recorder(const RecordingOptions& options, const Scene& scene, const Model& model,
                   std::vector<FrameSink*> sinks, const FrameSchedule& schedule)
    : options_(options), scene_(scene), model_(model), sinks_(std::move(sinks)), schedule_(schedule) {}

Recorder::~Recorder() = default;

Result<std::unique_ptr<Recorder>> Recorder::create(const RecordingOptions& options, const Scene& scene,
                                                   const Model& model, const Backend& backend,
                                                   std::vector<FrameSink*> sinks, std::uint64_t first_step,
                                                   std::uint64_t last_step) {
  const FrameSchedule schedule(model.simulation.timestep, first_step, last_step, frames_per_second(options),
                               options.speed);
  std::unique_ptr<Recorder> r(new Recorder(options, scene, model, std::move(sinks), schedule));
  r->context_ = backend.context.get();
  if (!r->context_) {
    auto context = gl::Context::create_headless();
    if (!context)
      return Error{context.error().code,
                   "pictures need an OpenGL device, if only a software one. " + context.error().message};
    r->own_context_ = std::move(*context);
    r->context_ = r->own_context_.get();
  }
  const auto directory = shader_directory();
  if (!directory) return directory.error();
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(*directory);
  auto renderer = Renderer::create(*r->context_, look);
  if (!renderer) return renderer.error();
  r->renderer_ = std::move(*renderer);
  if (const Status taken = r->renderer_->set_model(model); !taken) return taken.error();
  auto ring = gl::PixelRing::create(*r->context_, options.size.width, options.size.height);
  if (!ring) return ring.error();
  r->ring_ = std::make_unique<gl::PixelRing>(std::move(*ring));
  return r;
}

const std::string& Recorder::device() const {
  return context_->info().renderer;
}

std::uint64_t Recorder::next_step() const {
  return next_frame_ < schedule_.count() ? schedule_.step_of(next_frame_)
                                         : std::numeric_limits<std::uint64_t>::max();
}

Status Recorder::reach(Solver& solver, std::uint64_t step) {
  while (next_step() == step) {
    if (const Status drawn = draw(solver, step); !drawn) return drawn;
    ++next_frame_;
  }
  return {};
}

Status Recorder::draw(Solver& solver, std::uint64_t step) {
  if (ring_->full()) {
    if (const Status handed = hand_on(); !handed) return handed;
  }
  const Stopwatch watch(times_.draw);
  DeviceState drawn_state;
  if (const auto* gpu = dynamic_cast<const GpuSolver*>(&solver); gpu && !own_context_) {
    drawn_state = {&gpu->particles(), &gpu->balls(), gpu->first_ball(), step};
  } else {
    const auto state = solver.state();
    if (!state) return state.error();
    const auto uploaded = renderer_->upload(*state);
    if (!uploaded) return uploaded.error();
    drawn_state = *uploaded;
  }
  aspic::PictureOptions picture;
  picture.view = scene_.view;
  picture.legend = options_.text;
  if (options_.text)
    picture.text = overlay_lines(scene_.model, static_cast<double>(step) * model_.simulation.timestep);
  const Status drawn = renderer_->draw(options_.size.width, options_.size.height, drawn_state, picture);
  if (!drawn) return drawn;
  ring_->submit(renderer_->picture());
  last_shown_ = step;
  ++times_.frames;
  return {};
}

Status Recorder::hand_on() {
  {
    const Stopwatch watch(times_.read);
    if (const Status taken = ring_->take(pixels_); !taken) return taken;
  }
  const Stopwatch watch(times_.encode);
  for (FrameSink* sink : sinks_)
    if (const Status written = sink->write(pixels_); !written) return written;
  return {};
}

Status Recorder::finish(Solver& solver, std::uint64_t step) {
  if (times_.frames == 0 || last_shown_ != step) {
    if (const Status drawn = draw(solver, step); !drawn) return drawn;
  }
  while (ring_->pending() > 0)
    if (const Status handed = hand_on(); !handed) return handed;
  return {};
}

}  // namespace aspic
