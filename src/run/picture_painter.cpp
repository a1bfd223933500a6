#include "run/picture_painter.h"

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

Result<std::unique_ptr<PicturePainter>> PicturePainter::create(gl::Context& context, const PictureSize& size,
                                                               const std::vector<PaintedRun>& runs) {
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  std::unique_ptr<PicturePainter> p(new PicturePainter());
  p->context_ = &context;
  p->size_ = size;
  ASPIC_TRY(const auto directory, shader_directory());
  RendererOptions look;
  look.shaders = gl::ShaderLibrary(directory);
  for (const PaintedRun& run : runs) {
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

const gl::Framebuffer& PicturePainter::picture() const {
  return parts_.size() == 1 ? parts_.front().renderer->picture() : together_->picture();
}

Status PicturePainter::draw(const std::vector<DeviceState>& states, const std::vector<ShownRun>& shown) {
  assert(states.size() == parts_.size() && shown.size() == parts_.size());
  const gl::Current here(*context_);
  ASPIC_CHECK(here.status());
  if (!together_)
    return draw_part(parts_.front(), size_.width, size_.height, states.front(), shown.front(), std::nullopt);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    if (part.step == states[i].step) continue;
    ASPIC_TRY(part.own_range, part.renderer->range_of(states[i], part.run.scene->view, shown[i].channels));
    part.step = states[i].step;
    part.drawn_range.reset();
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    // The widest range of all that share a part's scale: only so can colours be compared.
    QuantityRange range = part.own_range;
    for (const Part& other : parts_)
      if (share_scale(part.run.scene->view, other.run.scene->view)) range = widest(range, other.own_range);
    if (part.drawn_range == range && part.drawn_text == shown[i].text) continue;
    const Tile& tile = together_->tiles()[i];
    ASPIC_CHECK(draw_part(part, tile.width, tile.height, states[i], shown[i], range));
    together_->place(i, part.renderer->picture(), shown[i].framed);
    part.drawn_range = range;
    part.drawn_text = shown[i].text;
  }
  return {};
}

Status PicturePainter::draw_part(Part& part, int width, int height, const DeviceState& state,
                                 const ShownRun& shown, const std::optional<QuantityRange>& range) {
  PictureOptions options;
  options.view = part.run.scene->view;
  options.view.camera = shown.camera;
  options.steady =
      !options.view.follow &&
      std::ranges::none_of(part.run.model->terrain, [](const Terrain& t) { return t.motion.has_value(); });
  options.text = shown.text;
  options.text_height = shown.text_height;
  options.legend = shown.legend;
  options.tint = shown.tint;
  options.arrows = shown.arrows;
  options.ball_turns = shown.ball_turns;
  options.channels = shown.channels;
  options.range = range;
  return part.renderer->draw(width, height, state, options);
}

}  // namespace aspic
