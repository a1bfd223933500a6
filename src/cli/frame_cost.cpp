#include "cli/frame_cost.h"

#include <glad/gl.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>

#include "gpu/current.h"
#include "gpu/pixel_ring.h"
#include "io/frame_schedule.h"
#include "render/frame_passes.h"
#include "render/overlay_text.h"
#include "render/renderer.h"
#include "run/window_host.h"
#include "variants/run_length.h"

namespace aspic::cli {
namespace {

/// Time since it was made.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  double cpu_seconds() const { return static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC; }
  gl::PassTime pass(const char* name) const { return {name, 1e3 * seconds(), 1, 1e3 * cpu_seconds()}; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_start_ = std::clock();
};

/// Sums of passes by name, in the order in which each came first.
void add(std::vector<gl::PassTime>& sums, const std::vector<gl::PassTime>& passes) {
  for (const gl::PassTime& pass : passes) {
    auto sum = std::ranges::find(sums, pass.name, &gl::PassTime::name);
    if (sum == sums.end()) sum = sums.insert(sums.end(), {pass.name});
    sum->milliseconds += pass.milliseconds;
    sum->dispatches += pass.dispatches;
    sum->processor_milliseconds += pass.processor_milliseconds;
  }
}

/// Renders as a recording does, and waits for each frame.
class FrameCostMeter {
 public:
  static Result<FrameCostMeter> create(const Scene& scene, const BackendChoice& choice,
                                       const SharedModel& model, const ImageSize& size) {
    FrameCostMeter m(scene, size);
    ASPIC_TRY(m.backend_, make_backend(choice, model));
    m.context_ = context_of(m.backend_);
    if (!m.context_) {
      ASPIC_TRY(m.own_context_, gl::Context::create_headless());
      m.context_ = m.own_context_.get();
    }
    RendererOptions look;
    ASPIC_TRY(const auto directory, gl::shader_directory());
    look.shaders = gl::ShaderLibrary(directory);
    ASPIC_TRY(m.renderer_, Renderer::create(*m.context_, look));
    ASPIC_CHECK(m.renderer_->set_model(*model));
    ASPIC_TRY(auto ring, gl::PixelRing::create(*m.context_, size.width, size.height));
    m.ring_.emplace(std::move(ring));
    return m;
  }

  Solver& solver() { return *backend_.solver; }
  const std::string& device() const { return context_->info().renderer; }

  /// Adds a frame of the solver's state to the cost.
  Status frame(FrameCost& cost) {
    const Stopwatch watch;
    ASPIC_TRY(const auto state, on_device());
    ASPIC_CHECK(draw(state));
    ring_->submit(renderer_->image());
    ASPIC_CHECK(ring_->take(pixels_));
    cost.seconds.push_back(watch.seconds());
    cost.cpu_seconds.push_back(watch.cpu_seconds());
    return {};
  }

  /// The same pass by pass, into sums.
  Status passes(std::vector<gl::PassTime>& sums) {
    const gl::Current here(*context_);
    ASPIC_CHECK(here.status());
    const Stopwatch uploading;
    ASPIC_TRY(const auto state, on_device());
    std::vector<gl::PassTime> all = {uploading.pass("state to the device")};
    renderer_->set_profiling(true);
    ASPIC_CHECK(draw(state));
    glFinish();  // completes the device's timestamps
    const std::vector<gl::PassTime> drawn = renderer_->pass_times();
    renderer_->set_profiling(false);
    if (drawn.empty()) return fail(ErrorCode::no_device, "{} gives no times of passes.", device());
    all.insert(all.end(), drawn.begin(), drawn.end());
    const Stopwatch reading;
    ring_->submit(renderer_->image());
    ASPIC_CHECK(ring_->take(pixels_));
    all.push_back(reading.pass("pixels to memory"));
    add(sums, all);
    return {};
  }

 private:
  FrameCostMeter(const Scene& scene, const ImageSize& size) : scene_(&scene), size_(size) {}

  Result<DeviceState> on_device() {
    if (const GpuSolver* const gpu = gpu_of(backend_)) return gpu->device_state();
    ASPIC_TRY(const auto state, backend_.solver->state());
    return renderer_->upload(state);
  }
  Status draw(const DeviceState& state) {
    ImageOptions options;
    options.view = scene_->view;
    const double h = backend_.solver->model().simulation.timestep;
    options.text = overlay_lines(*scene_, static_cast<double>(state.step) * h);
    return renderer_->draw(size_.width, size_.height, state, options);
  }

  const Scene* scene_;
  ImageSize size_;
  Backend backend_;
  gl::Context* context_ = nullptr;
  std::shared_ptr<gl::Context> own_context_;  // where the backend has none
  std::unique_ptr<Renderer> renderer_;
  std::optional<gl::PixelRing> ring_;
  std::vector<std::byte> pixels_;
};

}  // namespace

Result<FrameCost> measure_frames(const Scene& scene, const BackendChoice& choice,
                                 const FrameCostOptions& options, const std::function<bool()>& interrupted) {
  ASPIC_TRY(auto built, build_model(scene.model));
  const SharedModel shared_model = shared(std::move(built));
  const Model& model = *shared_model;
  ASPIC_TRY(auto meter, FrameCostMeter::create(scene, choice, shared_model, options.size));
  Solver& solver = meter.solver();
  ASPIC_TRY(const auto last, steps_of({std::nullopt, options.duration}, model.simulation));
  const FrameSchedule schedule(model.simulation.timestep, 0, last, 60.0, 1.0);
  FrameCost cost;
  cost.device = meter.device();
  std::uint64_t by_pass = 0;
  for (int repeat = -options.warm_up; repeat < options.repeats; ++repeat) {
    if (repeat == 0) {
      cost = {cost.device, {}, {}, {}};
      by_pass = 0;
    }
    ASPIC_CHECK(solver.load(initial_state(model, solver.precision())));
    std::uint64_t step = 0;
    for (std::uint64_t frame = 0; frame < schedule.count(); ++frame) {
      if (interrupted()) return Error{ErrorCode::interrupted, "interrupted; nothing was measured."};
      ASPIC_TRY(const auto advanced, solver.advance(schedule.step_of(frame) - step));
      if (advanced.divergence)
        return fail(ErrorCode::diverged, "the scene diverged in step {}.", advanced.divergence->step);
      step = schedule.step_of(frame);
      if (frame % 2 == 0) {
        ASPIC_CHECK(meter.frame(cost));
      } else {
        ASPIC_CHECK(meter.passes(cost.passes));
        ++by_pass;
      }
    }
  }
  for (gl::PassTime& pass : cost.passes) {
    pass.milliseconds /= static_cast<double>(by_pass);
    pass.dispatches /= static_cast<double>(by_pass);
    pass.processor_milliseconds /= static_cast<double>(by_pass);
  }
  return cost;
}

}  // namespace aspic::cli
