#include "run/beside_recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "render/camera.h"
#include "run/arrows.h"

namespace aspic {
namespace {

/// Ends of the colour scale that suit all runs with the same colour: only so can colours be compared.
QuantityRange common_range(const std::vector<PicturedRun>& runs, ViewColour colour) {
  QuantityRange range = default_range(runs.front().backend->solver->model(), colour);
  for (const PicturedRun& run : runs) {
    if (run.scene->view.colour != colour) continue;
    const QuantityRange own = default_range(run.backend->solver->model(), colour);
    range = {std::min(range[0], own[0]), std::max(range[1], own[1])};
  }
  return range;
}

}  // namespace

Result<std::unique_ptr<BesideRecorder>> BesideRecorder::create(
    gl::Context& context, const PictureOutput& output, std::vector<PicturedRun> runs,
    std::vector<std::unique_ptr<FrameSink>> sinks) {
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
    part.range = common_range(runs, runs[i].scene->view.colour);
    part.run = runs[i];
    ASPIC_TRY(part.renderer, Renderer::create(context, look));
    ASPIC_CHECK(part.renderer->set_model(part.run.backend->solver->model()));
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
  const auto before = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < parts_.size(); ++i) ASPIC_CHECK(draw(parts_[i], steps[i], divergences[i]));
  draw_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  return recording_->add(picture_.framebuffer, 1);
}

Status BesideRecorder::draw(Part& part, std::uint64_t step, const std::optional<Divergence>& divergence) {
  if (part.drawn_step == step && part.drawn_diverged == divergence.has_value()) return {};
  const Backend& backend = *part.run.backend;
  DeviceState state;
  if (backend.gpu) {
    state = backend.gpu->device_state();
  } else {
    ASPIC_TRY(const auto copy, backend.solver->state());
    ASPIC_TRY(state, part.renderer->upload(copy));
  }
  const double timestep = backend.solver->model().simulation.timestep;
  PictureOptions options;
  options.view = part.run.scene->view;
  options.view.camera = fitted(options.view.camera, part.tile.width, part.tile.height);
  ScaleSettings& scale = options.view.scale;
  if (has_scale(options.view.colour) && scale.range == ScaleRange::fixed) {
    scale.from = scale.from.value_or(part.range[0]);
    scale.to = scale.to.value_or(part.range[1]);
  }
  // One legend for all that share a scale.
  const ViewSettings& last = parts_.back().run.scene->view;
  const bool own_scale = follows_picture(options.view) || part.run.scene->view.scale != last.scale ||
                         options.view.colour != last.colour ||
                         (options.view.arrows.any() && !options.view.arrow_scale);
  options.legend = output_.text && (own_scale || &part == &parts_.back());
  if (options.view.arrows.any()) {
    ASPIC_TRY(const auto copy, backend.solver->state());
    options.arrows = arrows_of(backend.solver->model(), copy, options.view.arrows);
  }
  options.text_height = beside_text_height(output_.size.height, parts_.size());
  if (output_.text)
    options.text = beside_text(part.run.label, static_cast<double>(step) * timestep, timestep, divergence);
  ASPIC_CHECK(part.renderer->draw(part.tile.width, part.tile.height, state, options));
  picture_.framebuffer.place(part.renderer->picture(), part.tile.left,
                             output_.size.height - part.tile.top - part.tile.height);
  part.drawn_step = step;
  part.drawn_diverged = divergence.has_value();
  return {};
}

Status BesideRecorder::finish() {
  ASPIC_CHECK(recording_->end_complete());
  return recording_->result();
}

}  // namespace aspic
