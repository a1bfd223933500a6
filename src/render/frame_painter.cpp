#include "render/frame_painter.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "device/particles.h"
#include "gpu/current.h"

namespace aspic {

Result<DeviceState> upload(Renderer& renderer, Solver& solver) {
  std::vector<layout::Particle> particles(solver.model().particle_count());
  std::vector<layout::Ball> balls(solver.model().ball_count());
  ASPIC_TRY(const std::uint64_t step, read_packed(solver, particles, balls));
  return renderer.upload(std::move(particles), std::move(balls), step);
}

Result<std::unique_ptr<FramePainter>> FramePainter::create(gl::Context& context, const ImageSize& size,
                                                           const std::vector<RenderedRun>& runs) {
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  std::unique_ptr<FramePainter> p(new FramePainter());
  p->context_ = &context;
  p->size_ = size;
  ASPIC_TRY(const auto directory, gl::shader_directory());
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(directory);
  for (const RenderedRun& run : runs) {
    Part part{run, nullptr};
    ASPIC_TRY(part.renderer, Renderer::create(context, look));
    ASPIC_CHECK(part.renderer->set_model(*part.run.model));
    p->parts_.push_back(std::move(part));
  }
  if (runs.size() == 1) return p;
  ASPIC_TRY(p->together_, ComparisonCanvas::create(context, size));
  p->together_->divide(runs.size());
  return p;
}

const gl::Framebuffer& FramePainter::frame() const {
  return parts_.size() == 1 ? parts_.front().renderer->image() : together_->frame();
}

Status FramePainter::draw(const std::vector<DeviceState>& states, const std::vector<RunView>& views) {
  assert(states.size() == parts_.size() && views.size() == parts_.size());
  const gl::Current here(*context_);
  ASPIC_CHECK(here.status());
  if (!together_)
    return draw_part(parts_.front(), size_.width, size_.height, states.front(), views.front(), std::nullopt);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    if (part.step == states[i].step) continue;
    ASPIC_TRY(part.own_range, part.renderer->range_of(states[i], part.run.scene->view, views[i].channels));
    part.step = states[i].step;
    part.drawn_range.reset();
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    // The widest range of all that share a part's scale, so that colors can be compared.
    QuantityRange range = part.own_range;
    for (const Part& other : parts_)
      if (share_scale(part.run.scene->view, other.run.scene->view)) range = widest(range, other.own_range);
    if (part.drawn_range == range && part.drawn_text == views[i].text) continue;
    const Tile& tile = together_->tiles()[i];
    ASPIC_CHECK(draw_part(part, tile.width, tile.height, states[i], views[i], range));
    together_->place(i, part.renderer->image(), views[i].framed);
    part.drawn_range = range;
    part.drawn_text = views[i].text;
  }
  return {};
}

Status FramePainter::draw_part(Part& part, int width, int height, const DeviceState& state,
                               const RunView& view, const std::optional<QuantityRange>& range) {
  ImageOptions options;
  options.view = part.run.scene->view;
  options.view.camera = view.camera;
  options.steady =
      !options.view.follow &&
      std::ranges::none_of(part.run.model->terrain, [](const Terrain& t) { return t.motion.has_value(); });
  options.text = view.text;
  options.text_height = view.text_height;
  options.legend = view.legend;
  options.tint = view.tint;
  options.arrows = view.arrows;
  options.ball_turns = view.ball_turns;
  options.channels = view.channels;
  options.range = range;
  return part.renderer->draw(width, height, state, options);
}

}  // namespace aspic
