#include "render/highlight.h"

#include <glad/gl.h>

#include <array>

#include "render/light_maps.h"
#include "render/mesh.h"

namespace aspic {
namespace {

// Linear light.
constexpr std::array ring_color = {1.0f, 0.96f, 0.86f, 1.0f};
constexpr std::array pull_color = {1.0f, 0.62f, 0.08f, 1.0f};
constexpr std::array pinned_color = {0.95f, 0.95f, 0.92f, 1.0f};
constexpr std::array marked_color = {1.0f, 0.62f, 0.08f, 1.0f};

// Least radii, in units.
constexpr double ring_size = 9.0, pinned_size = 4.5, marked_size = 7.5, anchor_size = 8.0, line_size = 2.2;
/// Where something else hides it.
constexpr double hidden_opacity = 0.15;

}  // namespace

Result<std::unique_ptr<HighlightPainter>> HighlightPainter::create(
    const std::shared_ptr<RenderProgram::Source>& source) {
  gl::Context& context = source->context;
  std::unique_ptr<HighlightPainter> p(new HighlightPainter(context));
  p->marks_ = RenderProgram(source, {"render/particles.vert", "render/marks.frag", "render/marks.geom"});
  p->pull_ = RenderProgram(source, {"render/particles.vert", "render/marks.frag", "render/pull.geom"});
  ASPIC_TRY(p->frame_, gl::Buffer::create(context, "marks' frame", sizeof(render_layout::Frame),
                                          gl::BufferKind::uniform));
  return p;
}

Status HighlightPainter::list(const std::vector<std::uint32_t>& marked) {
  if (marked == listed_) return {};
  ASPIC_TRY(list_, gl::Buffer::of(*context_, "marked particles", marked));
  listed_ = marked;
  return {};
}

void HighlightPainter::draw_all(const ModelBuffers& model, const gl::Buffer& particles,
                                const DrawSettings& draw, const HighlightOptions& options,
                                const Tone& tone) const {
  const float radius = draw.particles ? static_cast<float>(particle_radius(model.spacing())) : 0.0f;
  const auto prepare = [&](const RenderProgram& program, float style, double size,
                           const std::array<float, 4>& color, float share) {
    if (style != MARK_LINE) program.set(LOCATION_RADIUS, share * radius);
    program.set(LOCATION_BASE_COLOR, color);
    program.set(LOCATION_MARK, std::array{style, static_cast<float>(size * options.unit),
                                          static_cast<float>(tone.opacity), tone.encoded ? 1.0f : 0.0f});
    program.set(LOCATION_ANCHOR, std::array{0.0f, 0.0f, 0.0f, 0.0f});
    glUseProgram(program.id());
  };
  const auto point = [](std::uint32_t particle) { glDrawArrays(GL_POINTS, static_cast<GLint>(particle), 1); };
  const gl::VertexArray points = model.particle_array(particles);
  points.bind();
  if (options.pinned && draw.particles) {
    prepare(marks_, MARK_PINNED, pinned_size, pinned_color, 0.7f);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(model.particle_count()));
  }
  if (!options.marked.empty()) {
    const gl::VertexArray marked = model.listed_array(particles, list_);
    marked.bind();
    prepare(marks_, MARK_DIAMOND, marked_size, marked_color, 1.1f);
    glDrawElements(GL_POINTS, static_cast<GLsizei>(options.marked.size()), GL_UNSIGNED_INT, nullptr);
    points.bind();
  }
  if (options.pull) {
    prepare(pull_, MARK_LINE, line_size, pull_color, 0.0f);
    pull_.set(LOCATION_ANCHOR, four(options.pull->anchor, 1.0));
    point(options.pull->particle);
    prepare(marks_, MARK_ANCHOR, anchor_size, pull_color, 0.0f);
    marks_.set(LOCATION_ANCHOR, four(options.pull->anchor, 1.0));
    point(options.pull->particle);
  }
  if (options.hovered) {
    prepare(marks_, MARK_RING, ring_size, ring_color, 1.8f);
    point(*options.hovered);
  }
}

Status HighlightPainter::draw_within(const ModelBuffers& model, const gl::Buffer& particles,
                                     const DrawSettings& draw, const HighlightOptions& options) {
  ASPIC_CHECK(list(options.marked));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  draw_all(model, particles, draw, options, {.opacity = hidden_opacity});
  glDepthFunc(GL_LEQUAL);
  draw_all(model, particles, draw, options, {});
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return {};
}

Status HighlightPainter::draw_over(const ModelBuffers& model, const gl::Buffer& particles,
                                   const DrawSettings& draw, const HighlightOptions& options,
                                   const render_layout::Frame& frame) {
  ASPIC_CHECK(list(options.marked));
  frame_.upload_items(std::span(&frame, 1));
  frame_.bind(gl::BufferKind::uniform, BINDING_FRAME);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_all(model, particles, draw, options, {.encoded = true});
  glDisable(GL_BLEND);
  return {};
}

}  // namespace aspic
