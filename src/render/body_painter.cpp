#include "render/body_painter.h"

#include <glad/gl.h>

#include <algorithm>

#include "render/color_map.h"
#include "render/light_maps.h"

namespace aspic {
namespace {

/// Cords of nets: dark, since grounds and sky are light.
constexpr Color net_color = {0.035f, 0.040f, 0.055f};

}  // namespace

double light_reach(const Body& body) {
  return 0.30 * body.size;
}

template <class Prepare>
void BodyPainter::draw_skins(SurfaceStyle style, const Prepare& prepare) const {
  const SkinsCut cut(view.cut);
  for (std::size_t i = 0; i < buffers.parts().size(); ++i) {
    if (buffers.parts()[i].index_count == 0 || model.bodies[i].style != style) continue;
    prepare(i);
    draw_triangles(buffers.parts()[i]);
  }
}

void BodyPainter::draw_thickness() const {
  targets.thickness.framebuffer.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(programs.thickness.id());
  const gl::VertexArray skin = buffers.skin_array(*state.particles), own = buffers.shaded_skin_array();
  draw_skins(SurfaceStyle::flesh,
             [&](std::size_t body) { (buffers.parts()[body].mesh ? own : skin).bind(); });
  if (section) section->draw(SectionUse::thickness, model, buffers, *state.particles, view.color);
  glDisable(GL_BLEND);
  targets.thickness.color.bind(UNIT_THICKNESS);
}

void BodyPainter::draw_rods_and_balls() const {
  if (view.draw.solid && !buffers.rods().empty()) {
    programs.rods.set(LOCATION_BASE_COLOR, std::array{0.94f, 0.94f, 0.94f, 1.0f});
    glUseProgram(programs.rods.id());
    buffers.rods().draw();
  }
  if (!draws_balls(view.draw)) return;
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  if (buffers.balls().shows(state)) buffers.balls().draw(programs.balls, state);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void BodyPainter::draw_particles() const {
  if (!view.draw.particles) return;
  programs.particles.set(LOCATION_RADIUS, static_cast<float>(particle_radius(buffers.spacing())));
  programs.particles.set(LOCATION_BASE_COLOR, std::array{0.62f, 0.64f, 0.68f, 1.0f});
  glUseProgram(programs.particles.id());
  const gl::VertexArray points = buffers.particle_array(*state.particles);
  points.bind();
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(buffers.particle_count()));
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void BodyPainter::draw_section() const {
  if (section) section->draw(SectionUse::color, model, buffers, *state.particles, view.color);
}

void BodyPainter::draw_springs() const {
  const DrawSettings draw = drawn_springs(view);
  if (!aspic::draws_springs(draw)) return;
  glUseProgram(programs.springs.id());
  programs.springs.set(LOCATION_FADES, 0);
  const gl::VertexArray lines = buffers.spring_array(*state.particles);
  lines.bind();
  for (const SpringRun& run : buffers.springs())
    if (draws(draw, run.constants.type)) draw_run(run);
}

void BodyPainter::draw_cords() const {
  if (std::ranges::none_of(buffers.springs(),
                           [&](const SpringRun& run) { return draws_as_cord(view.draw, run); }))
    return;
  glUseProgram(programs.springs.id());
  programs.springs.set(LOCATION_FADES, 1);
  const gl::VertexArray lines = buffers.spring_array(*state.particles);
  lines.bind();
  color_map.bind(UNIT_COLOR_MAP);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const SpringRun& run : buffers.springs())
    if (draws_as_cord(view.draw, run)) draw_run(run);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void BodyPainter::draw_run(const SpringRun& run) const {
  const SpringClass& c = run.constants;
  if (run.index_count == 0) return;
  const bool plain = draws_as_cord(view.draw, run) && view.color != ViewColor::type;
  programs.springs.set(LOCATION_BASE_COLOR, with_alpha(plain ? net_color : spring_color(c.type), 1.0));
  programs.springs.set(LOCATION_SPRING,
                       std::array{static_cast<float>(c.stiffness), static_cast<float>(c.damping),
                                  static_cast<float>(c.rest_length), c.cord ? 1.0f : 0.0f});
  programs.springs.set(LOCATION_RADIUS, static_cast<float>(spring_radius(buffers.spacing(), c.type)));
  draw_lines(run);
}

void BodyPainter::draw_jelly(JellySide side) const {
  const gl::Program& program = side == JellySide::far ? programs.jelly_far : programs.jelly;
  glEnable(GL_CULL_FACE);
  glCullFace(side == JellySide::far ? GL_FRONT : GL_BACK);
  if (side == JellySide::far) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
  }
  targets.behind.color.bind(UNIT_BEHIND);
  color_map.bind(UNIT_COLOR_MAP);
  draw_parts(program, SurfaceStyle::flesh);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glCullFace(GL_BACK);
  glDisable(GL_CULL_FACE);
}

void BodyPainter::draw_sheets() const {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  // Springs and particles lie in the surface: it gives way to them.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0f, 1.0f);
  color_map.bind(UNIT_COLOR_MAP);
  draw_parts(programs.sheet, SurfaceStyle::sheet);
  glPolygonOffset(0.0f, 0.0f);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_BLEND);
}

void BodyPainter::draw_parts(const gl::Program& program, SurfaceStyle style) const {
  glUseProgram(program.id());
  const gl::VertexArray skin = buffers.shaded_skin_array();
  skin.bind();
  draw_skins(style, [&](std::size_t body) {
    const Color own = tint ? *tint : body_color(body);
    const Color color = view.color == ViewColor::material ? own : neutral_body_color();
    program.set(LOCATION_BASE_COLOR, with_alpha(color, light_reach(model.bodies[body])));
  });
}

}  // namespace aspic
