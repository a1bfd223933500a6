#include "render/light_maps.h"

#include <glad/gl.h>

#include <utility>

#include "render/section.h"

namespace aspic {
namespace {

constexpr int sun_size = 512;
constexpr int sky_size = 256;

}  // namespace

double particle_radius(double spacing) {
  return 0.16 * spacing;
}

double spring_radius(double spacing, SpringType type) {
  return (type == SpringType::structural ? 0.026 : type == SpringType::shear ? 0.014 : 0.018) * spacing;
}

bool draws(const DrawSettings& draw, SpringType type) {
  const bool by_type[] = {draw.structural, draw.shear, draw.bending};
  return by_type[static_cast<std::size_t>(type)];
}

bool draws_as_cord(const DrawSettings& draw, const SpringRun& run) {
  return run.cords && draw.solid && !draw.structural && run.constants.type == SpringType::structural;
}

bool draws_balls(const DrawSettings& draw) {
  return draw.solid || draw.particles;
}

Result<LightMaps> LightMaps::create(gl::Context& context) {
  LightMaps result;
  for (int light = 0; light < LIGHTS; ++light) {
    const bool sun = light == LIGHT_SUN;
    const int size = sun ? sun_size : sky_size;
    const gl::TexelFormat format = sun ? gl::TexelFormat::rg16f : gl::TexelFormat::rgba16f;
    ASPIC_TRY(result.maps_[static_cast<std::size_t>(light)],
              DrawableImage::create(context, sun ? "sun map" : "sky map",
                                    {.format = format, .width = size, .height = size, .mipmaps = true}, sun));
  }
  ASPIC_TRY(result.empty_,
            DrawableImage::create(context, "empty light map", {.format = gl::TexelFormat::rg16f}, false));
  result.empty_.framebuffer.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return result;
}

bool LightMaps::hold(const std::optional<LightLook>& look) {
  return std::exchange(look_, look) == look && look.has_value();
}

void LightMaps::bind(const ModelBuffers& model) const {
  model.light_boxes().bind(gl::BufferKind::uniform, BINDING_LIGHT_BOXES);
  maps_[LIGHT_SUN].color.bind(UNIT_SUN_MAP);
  maps_[LIGHT_SKY].color.bind(UNIT_SKY_MAP);
}

void LightMaps::leave_out(const ModelBuffers& model) {
  model.light_boxes().bind(gl::BufferKind::uniform, BINDING_LIGHT_BOXES);
  empty_.color.bind(UNIT_SUN_MAP);
  empty_.color.bind(UNIT_SKY_MAP);
}

void LightMaps::render(const RenderPrograms& programs, const ModelBuffers& model, const DeviceState& state,
                       const ViewSettings& view) {
  const DrawSettings& draw = view.draw;
  model.light_boxes().bind(gl::BufferKind::uniform, BINDING_LIGHT_BOXES);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  const gl::VertexArray skin = model.skin_array(*state.particles), own = model.shaded_skin_array();
  const gl::VertexArray points = model.particle_array(*state.particles);
  const gl::VertexArray lines = model.spring_array(*state.particles);
  for (int light = 0; light < LIGHTS; ++light) {
    DrawableImage& map = maps_[static_cast<std::size_t>(light)];
    map.framebuffer.bind();
    // The surfaces nearest to the sun; below the sky the highest and the lowest of all, in whatever order.
    const bool sun = light == LIGHT_SUN;
    (sun ? glEnable : glDisable)(GL_DEPTH_TEST);
    (sun ? glDisable : glEnable)(GL_BLEND);
    glBlendEquation(sun ? GL_FUNC_ADD : GL_MAX);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (draw.solid) {
      programs.light_surface.set(LOCATION_LIGHT, light);
      glUseProgram(programs.light_surface.id());
      {
        const SkinsCut cut(view.cut);
        for (const Surface::Part& part : model.parts()) {
          (part.mesh ? own : skin).bind();
          draw_triangles(part);
        }
      }
      model.rods().draw();
    }
    if (draws_balls(draw) && model.balls().shows(state)) {
      programs.light_balls.set(LOCATION_LIGHT, light);
      programs.light_balls.set(LOCATION_RADIUS, 1.0f);
      model.balls().draw(programs.light_balls, state);
    }
    if (draw.particles) {
      programs.light_particles.set(LOCATION_LIGHT, light);
      programs.light_particles.set(LOCATION_RADIUS, static_cast<float>(particle_radius(model.spacing())));
      glUseProgram(programs.light_particles.id());
      points.bind();
      glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(model.particle_count()));
    }
    lines.bind();
    for (const SpringRun& run : model.springs()) {
      if (!draws(draw, run.constants.type)) continue;
      glUseProgram(programs.light_springs.id());
      programs.light_springs.set(LOCATION_LIGHT, light);
      programs.light_springs.set(LOCATION_RADIUS,
                                 static_cast<float>(spring_radius(model.spacing(), run.constants.type)));
      draw_lines(run);
    }
    map.color.generate_mipmaps();
  }
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  bind(model);
  glBindVertexArray(0);
}

}  // namespace aspic
