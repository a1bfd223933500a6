#include "variants/comparison_recorder.h"

#include <utility>

#include "model/reading.h"
#include "render/camera.h"
#include "render/run_view.h"
#include "render/state_arrows.h"
#include "run/window_host.h"

namespace aspic {

Result<std::unique_ptr<ComparisonRecorder>> ComparisonRecorder::create(
    gl::Context& context, const ImageOutput& output, std::vector<RecordedRun> runs,
    std::vector<std::unique_ptr<FrameSink>> sinks) {
  std::unique_ptr<ComparisonRecorder> r(new ComparisonRecorder());
  r->output_ = output;
  const std::vector<Tile> tiles = tiles_of(output.size, runs.size());
  std::vector<RenderedRun> rendered;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Part part = {runs[i], i, tiles[i]};
    const Solver& solver = *part.run.backend->solver;
    part.following = Following(*part.run.scene, solver.model(), solver.precision());
    rendered.push_back({part.run.scene, &solver.model()});
    r->parts_.push_back(std::move(part));
  }
  ASPIC_TRY(r->video_, VideoPainter::create(context, output, std::move(rendered), std::move(sinks)));
  return r;
}

FrameTimes ComparisonRecorder::times() const {
  FrameTimes times = video_->times();
  times.simulate = simulate_seconds_;
  return times;
}

Status ComparisonRecorder::add(const std::vector<std::uint64_t>& steps,
                               const std::vector<std::optional<Divergence>>& divergences) {
  std::vector<RenderedState> states;
  std::vector<RunView> all;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    ASPIC_CHECK(take_state(part, steps[i]));
    const Backend& backend = *part.run.backend;
    const GpuSolver* const gpu = gpu_of(backend);
    states.push_back({backend.solver.get(), gpu ? gpu->device_state() : DeviceState()});
    all.push_back(view_of(part, divergences[i]));
  }
  return video_->add(states, std::move(all), 1);
}

/// A copy of the state of a part's run, where one is needed.
Status ComparisonRecorder::take_state(Part& part, std::uint64_t step) {
  if (part.step == step) return {};
  const Backend& backend = *part.run.backend;
  if (needs_copy(*part.run.scene, part.following)) ASPIC_CHECK(read_state(*backend.solver, part.copy));
  part.step = step;
  return {};
}

RunView ComparisonRecorder::view_of(const Part& part, const std::optional<Divergence>& divergence) const {
  const Model& model = part.run.backend->solver->model();
  const double timestep = model.simulation.timestep;
  const ViewSettings& view = part.run.scene->view;
  RunView shown;
  shown.camera =
      fitted(moved(view.camera, part.following.offset(model, part.copy)), part.tile.width, part.tile.height);
  // One legend for all that share a scale.
  const ViewSettings& last = parts_.back().run.scene->view;
  const bool own_scale =
      view.scale != last.scale || view.color != last.color || (view.arrows.any() && !view.arrow_scale);
  shown.legend = output_.text && (own_scale || &part == &parts_.back());
  if (view.arrows.any())
    shown.arrows = arrows_of(model, part.copy, view.arrows, part.run.backend->solver->inputs());
  shown.channels = part.run.backend->solver->inputs().channels;
  shown.text_height = comparison_text_height(output_.size.height, parts_.size());
  if (output_.text) {
    shown.text = comparison_text(part.run.name, part.number, static_cast<double>(*part.step) * timestep,
                                 timestep, divergence);
    if (part.number == 0) shown.text = below_author(*part.run.scene, std::move(shown.text));
    shown.tint = run_tint(part.number);
    shown.framed = true;
  }
  return shown;
}

Status ComparisonRecorder::finish() {
  return video_->finish();
}

}  // namespace aspic
