#include "run/beside_recorder.h"

#include <chrono>
#include <utility>

#include "gpu/current.h"
#include "render/camera.h"
#include "run/arrows.h"

namespace aspic {

Result<std::unique_ptr<BesideRecorder>> BesideRecorder::create(
    gl::Context& context, const PictureOutput& output, std::vector<PicturedRun> runs,
    std::vector<std::unique_ptr<FrameSink>> sinks) {
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  std::unique_ptr<BesideRecorder> r(new BesideRecorder());
  r->context_ = &context;
  r->output_ = output;
  ASPIC_TRY(const auto directory, shader_directory());
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(directory);
  const std::vector<Tile> tiles = tiles_of(output.size, runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Part part;
    part.tile = tiles[i];
    part.run = runs[i];
    ASPIC_TRY(part.renderer, Renderer::create(context, look));
    const Solver& solver = *part.run.backend->solver;
    ASPIC_CHECK(part.renderer->set_model(solver.model()));
    part.following = Following(*part.run.scene, solver.model(), solver.precision());
    r->parts_.push_back(std::move(part));
  }
  ASPIC_TRY(r->picture_,
            DrawableImage::create(context, "runs side by side",
                                  {.width = output.size.width, .height = output.size.height}, false));
  r->picture_.framebuffer.clear();
  FilmOptions film = {sinks.front()->path(), frames_per_second(output), output.size};
  ASPIC_TRY(r->recording_, Recording::start(context, std::move(sinks), std::move(film)));
  return r;
}

FrameTimes BesideRecorder::times() const {
  FrameTimes times = recording_->times();
  times.simulate = simulate_seconds_;
  times.draw = draw_seconds_;
  return times;
}

Status BesideRecorder::add(const std::vector<std::uint64_t>& steps,
                           const std::vector<std::optional<Divergence>>& divergences) {
  recording_->wait_until_ready();
  // Nothing but an error completes the film before its end.
  if (recording_->completed()) return recording_->result();
  const gl::Current here(*context_);
  ASPIC_CHECK(here.status());
  const auto before = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < parts_.size(); ++i) ASPIC_CHECK(take_state(parts_[i], steps[i]));
  for (std::size_t i = 0; i < parts_.size(); ++i)
    ASPIC_CHECK(draw(parts_[i], common_range(parts_[i]), divergences[i]));
  draw_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return recording_->add(picture_.framebuffer, 1);
}

/// The state of a part's run, and the range of colours that it would have alone.
Status BesideRecorder::take_state(Part& part, std::uint64_t step) {
  if (part.step == step) return {};
  const ViewSettings& view = part.run.scene->view;
  const Backend& backend = *part.run.backend;
  if (!backend.gpu || part.following.any() || view.arrows.any()) {
    ASPIC_TRY(part.copy, backend.solver->state());
  }
  if (backend.gpu) {
    part.state = backend.gpu->device_state();
  } else {
    ASPIC_TRY(part.state, part.renderer->upload(part.copy));
  }
  ASPIC_TRY(part.own_range, part.renderer->range_of(part.state, view));
  part.step = step;
  part.drawn_range.reset();
  return {};
}

/// The widest range of all that share a part's scale: only so can colours be compared.
QuantityRange BesideRecorder::common_range(const Part& part) const {
  QuantityRange range = part.own_range;
  for (const Part& other : parts_)
    if (share_scale(part.run.scene->view, other.run.scene->view)) range = widest(range, other.own_range);
  return range;
}

Status BesideRecorder::draw(Part& part, const QuantityRange& range,
                            const std::optional<Divergence>& divergence) {
  if (part.drawn_range == range && part.drawn_diverged == divergence.has_value()) return {};
  const Model& model = part.run.backend->solver->model();
  const double timestep = model.simulation.timestep;
  PictureOptions options;
  options.view = part.run.scene->view;
  options.view.camera = fitted(moved(options.view.camera, part.following.offset(model, part.copy)),
                               part.tile.width, part.tile.height);
  options.range = range;
  // One legend for all that share a scale.
  const ViewSettings& last = parts_.back().run.scene->view;
  const bool own_scale = options.view.scale != last.scale || options.view.colour != last.colour ||
                         (options.view.arrows.any() && !options.view.arrow_scale);
  options.legend = output_.text && (own_scale || &part == &parts_.back());
  if (options.view.arrows.any()) options.arrows = arrows_of(model, part.copy, options.view.arrows);
  options.text_height = beside_text_height(output_.size.height, parts_.size());
  if (output_.text)
    options.text =
        beside_text(part.run.label, static_cast<double>(*part.step) * timestep, timestep, divergence);
  ASPIC_CHECK(part.renderer->draw(part.tile.width, part.tile.height, part.state, options));
  picture_.framebuffer.place(part.renderer->picture(), part.tile.left,
                             output_.size.height - part.tile.top - part.tile.height);
  part.drawn_range = range;
  part.drawn_diverged = divergence.has_value();
  return {};
}

Status BesideRecorder::finish() {
  ASPIC_CHECK(recording_->end_complete());
  return recording_->result();
}

}  // namespace aspic
