#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "gpu/pass.h"
#include "render/light_maps.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "render/targets.h"
#include "render/terrain_painter.h"

namespace aspic {
namespace {

/// Towards the sun: from behind on the left of the default camera, so that light shines through bodies; from
/// the right where that would leave a slope in the dark.
glm::vec3 sun_over(const std::vector<Terrain>& terrain) {
  const auto least_slant = [&](const glm::vec3& sun) {
    float least = 1.0f;
    for (const Terrain& t : terrain)
      if (t.shape == TerrainShape::plane || t.shape == TerrainShape::tilted_plane)
        least = std::min(least, glm::dot(sun, glm::vec3(t.normal.x, t.normal.y, t.normal.z)));
    return least;
  };
  const glm::vec3 left = glm::normalize(glm::vec3(-0.60f, 0.78f, -0.12f));
  const glm::vec3 right = glm::normalize(glm::vec3(0.35f, 0.85f, -0.38f));
  return least_slant(left) >= 0.5f || least_slant(left) >= least_slant(right) ? left : right;
}

/// The walls of a translucent body that face away from the eye, or towards it.
enum class JellySide { far, near };

/// Cords of goal nets.
constexpr Colour net_colour = {0.98f, 0.98f, 0.98f};

/// How deep light reaches into a body [m], as a share of its size.
constexpr double reach_share = 0.30;

/// A rotation that looks along `direction`: z of the result grows away from the light.
glm::mat4 light_rotation(const glm::vec3& towards_light) {
  const glm::vec3 up = std::abs(towards_light.y) > 0.999f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 z = -towards_light;
  const glm::vec3 x = glm::normalize(glm::cross(up, z));
  const glm::vec3 y = glm::cross(z, x);
  return glm::transpose(glm::mat4(glm::mat3(x, y, z)));
}

std::array<float, 4> with(const Colour& c, double w) {
  return {c[0], c[1], c[2], static_cast<float>(w)};
}

bool shows_springs(const DrawSettings& draw) {
  return draw.structural || draw.shear || draw.bending;
}

void draw_elements(GLenum mode, std::uint32_t first, std::uint32_t count) {
  glDrawElements(mode, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(sizeof(GLuint) * std::uintptr_t{first}));
}

}  // namespace

struct Renderer::Parts {
  Parts(gl::Context& c, RenderPrograms p, OverlayPainter o, TerrainPainter t, LightMaps l)
      : context(&c),
        programs(std::move(p)),
        overlay(std::move(o)),
        terrain(std::move(t)),
        lights(std::move(l)) {}

  gl::Context* context;
  RenderPrograms programs;
  OverlayPainter overlay;
  TerrainPainter terrain;
  LightMaps lights;
  gl::Texture colour_map;
  gl::Buffer frame;
  gl::VertexArray nothing;
  int samples = 4;
  std::optional<PictureTargets> targets;
  const Model* model = nullptr;
  std::optional<ModelBuffers> buffers;
  gl::Buffer uploaded, uploaded_balls;

  Status prepare_targets(int width, int height);
  void write_frame(const PictureOptions& options, const Camera& camera, int width, int height,
                   const QuantityRange& range);
  void prepare_light(const DeviceState& state, const PictureOptions& options);
  void draw_thickness(const gl::Buffer& particles) const;
  void draw_particles(const gl::Buffer& particles, const DrawSettings& draw) const;
  void draw_springs(const gl::Buffer& particles, const DrawSettings& draw, ViewColour mode) const;
  void draw_jelly(const gl::Buffer& particles, const ViewSettings& view, JellySide side) const;
};

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(gl::Context& context, const RendererOptions& options) {
  auto programs = RenderPrograms::create(context, options.shaders);
  if (!programs) return programs.error();
  auto overlay = OverlayPainter::create(context, options.shaders);
  if (!overlay) return overlay.error();
  auto terrain = TerrainPainter::create(context);
  if (!terrain) return terrain.error();
  auto lights = LightMaps::create(context);
  if (!lights) return lights.error();
  auto parts = std::make_unique<Parts>(context, std::move(*programs), std::move(*overlay),
                                       std::move(*terrain), std::move(*lights));
  auto map = gl::Texture::create(context, "colour map", {.width = 256, .height = 1});
  if (!map) return map.error();
  map->upload(colour_map_texels());
  parts->colour_map = std::move(*map);
  auto frame = gl::Buffer::create(context, "frame", sizeof(render_layout::Frame), gl::BufferKind::uniform);
  if (!frame) return frame.error();
  parts->frame = std::move(*frame);
  parts->nothing = gl::VertexArray::create({});
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  parts->samples = std::clamp(options.samples, 1, static_cast<int>(most));
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

Status Renderer::set_model(const Model& model) {
  auto buffers = ModelBuffers::create(*parts_->context, model);
  if (!buffers) return buffers.error();
  parts_->buffers.reset();
  parts_->buffers.emplace(std::move(*buffers));
  parts_->model = &model;
  return {};
}

Result<DeviceState> Renderer::upload(const State& state) {
  Parts& p = *parts_;
  assert(p.model);
  Status status = ModelBuffers::upload(*p.context, *p.model, state, p.uploaded);
  if (status) status = BallBuffers::upload(*p.context, *p.model, state, p.uploaded_balls);
  if (!status) return status.error();
  return DeviceState{&p.uploaded, &p.uploaded_balls, 0, state.step};
}

Status Renderer::Parts::prepare_targets(int width, int height) {
  if (targets && targets->picture.colour.width() == width && targets->picture.colour.height() == height)
    return {};
  targets.reset();
  auto made = PictureTargets::create(*context, width, height, samples);
  if (!made) return made.error();
  targets.emplace(std::move(*made));
  return {};
}

void Renderer::Parts::write_frame(const PictureOptions& options, const Camera& camera, int width, int height,
                                  const QuantityRange& range) {
  render_layout::Frame block = {};
  block.view = camera.view();
  block.projection = camera.projection();
  block.view_projection = camera.projection() * camera.view();
  block.clip_to_world = glm::inverse(block.view_projection);
  const glm::vec3 to_sun = sun_over(model->terrain);
  block.lights[LIGHT_SUN] = light_rotation(to_sun);
  // The sky's light falls on a slope squarely, as far as shadow goes: contact darkens there, not downhill.
  glm::vec3 above(0, 1, 0);
  for (const Terrain& t : model->terrain) {
    if (t.shape != TerrainShape::plane && t.shape != TerrainShape::tilted_plane) continue;
    above = glm::vec3(t.normal.x, t.normal.y, t.normal.z);
    break;
  }
  block.lights[LIGHT_SKY] = light_rotation(above);
  block.eye = glm::vec4(camera.eye(), camera.target_distance());
  block.sun = glm::vec4(to_sun, 0);
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  block.viewport = glm::vec4(w, h, 1.0f / w, 1.0f / h);
  const Colour tint = options.view.colour == ViewColour::material ? body_colour(0) : neutral_body_colour();
  const bool solid = options.view.draw.solid && buffers->has_skin();
  for (std::size_t i = 0; i < 3; ++i)
    block.shadow_tint[static_cast<int>(i)] = solid ? 0.10f + 0.22f * tint[i] : 0.15f;
  const double width_of_range = range[1] - range[0];
  block.quantity_range = glm::vec4(range[0], width_of_range > 0.0 ? 1.0 / width_of_range : 0.0, 0, 0);
  for (const Terrain& t : model->terrain) {
    if (t.shape != TerrainShape::sphere || block.shadow_sphere_count == MAX_SHADOW_SPHERES) continue;
    block.shadow_spheres[block.shadow_sphere_count++] = glm::vec4(t.point.x, t.point.y, t.point.z, t.radius);
  }
  switch (options.view.colour) {
    case ViewColour::material:
      block.colour_mode = COLOUR_MATERIAL;
      break;
    case ViewColour::type:
      block.colour_mode = COLOUR_TYPE;
      break;
    case ViewColour::strain:
      block.colour_mode = COLOUR_STRAIN;
      break;
    case ViewColour::force:
      block.colour_mode = COLOUR_FORCE;
      break;
    case ViewColour::speed:
      block.colour_mode = COLOUR_SPEED;
      break;
  }
  block.particle_count = buffers->particle_count();
  block.see_through = options.view.draw.particles || shows_springs(options.view.draw) ? 1.0f : 0.0f;
  frame.upload_items(std::span<const render_layout::Frame>(&block, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, BINDING_FRAME, frame.id());
}

void Renderer::Parts::prepare_light(const DeviceState& state, const PictureOptions& options) {
  const gl::Buffer& particles = *state.particles;
  buffers->compute_light_boxes(programs, state);
  if (options.view.draw.solid && buffers->has_skin()) buffers->compute_normals(programs, particles);
  if (options.view.colour >= ViewColour::strain) buffers->compute_quantity(programs, particles);
  lights.render(programs, *buffers, state, options.view.draw);
}

void Renderer::Parts::draw_thickness(const gl::Buffer& particles) const {
  targets->thickness.framebuffer.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glUseProgram(programs.thickness.id());
  const gl::VertexArray skin = buffers->skin_array(particles);
  skin.bind();
  for (const Surface::Part& part : buffers->parts())
    draw_elements(GL_TRIANGLES, part.first_index, part.index_count);
  glDisable(GL_BLEND);
  targets->thickness.colour.bind(UNIT_THICKNESS);
}

void Renderer::Parts::draw_particles(const gl::Buffer& particles, const DrawSettings& draw) const {
  if (!draw.particles) return;
  programs.particles.set(LOCATION_RADIUS, static_cast<float>(particle_radius(buffers->spacing())));
  programs.particles.set(LOCATION_BASE_COLOUR, std::array{0.62f, 0.64f, 0.68f, 1.0f});
  glUseProgram(programs.particles.id());
  const gl::VertexArray points = buffers->particle_array(particles);
  points.bind();
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(buffers->particle_count()));
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Renderer::Parts::draw_springs(const gl::Buffer& particles, const DrawSettings& draw,
                                   ViewColour mode) const {
  glUseProgram(programs.springs.id());
  const gl::VertexArray lines = buffers->spring_array(particles);
  lines.bind();
  for (const SpringRun& run : buffers->springs()) {
    const SpringClass& c = run.constants;
    const bool cord = draws_as_cord(draw, run);
    if (!(cord || draws(draw, c.type)) || run.index_count == 0) continue;
    const Colour colour = cord && mode != ViewColour::type ? net_colour : spring_colour(c.type);
    programs.springs.set(LOCATION_BASE_COLOUR, with(colour, 1.0));
    programs.springs.set(LOCATION_SPRING,
                         std::array{static_cast<float>(c.stiffness), static_cast<float>(c.damping),
                                    static_cast<float>(c.rest_length), c.cord ? 1.0f : 0.0f});
    programs.springs.set(LOCATION_RADIUS, static_cast<float>(spring_radius(buffers->spacing(), c.type)));
    draw_elements(GL_LINES, run.first_index, run.index_count);
  }
}

void Renderer::Parts::draw_jelly(const gl::Buffer& particles, const ViewSettings& view,
                                 JellySide side) const {
  const gl::Program& program = side == JellySide::far ? programs.jelly_far : programs.jelly;
  glEnable(GL_CULL_FACE);
  glCullFace(side == JellySide::far ? GL_FRONT : GL_BACK);
  if (side == JellySide::far) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
  }
  targets->behind.colour.bind(UNIT_BEHIND);
  colour_map.bind(UNIT_COLOUR_MAP);
  glUseProgram(program.id());
  const gl::VertexArray skin = buffers->skin_array(particles);
  skin.bind();
  for (std::size_t i = 0; i < buffers->parts().size(); ++i) {
    const Surface::Part& part = buffers->parts()[i];
    if (part.index_count == 0) continue;
    const Body& body = model->bodies[i];
    const double size = body.spacing * (*std::ranges::max_element(body.lattice) - 1);
    const Colour colour = view.colour == ViewColour::material ? body_colour(i) : neutral_body_colour();
    program.set(LOCATION_BASE_COLOUR, with(colour, reach_share * size));
    draw_elements(GL_TRIANGLES, part.first_index, part.index_count);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glCullFace(GL_BACK);
  glDisable(GL_CULL_FACE);
}

Status Renderer::draw(int width, int height, const DeviceState& state, const PictureOptions& options) {
  Parts& p = *parts_;
  assert(p.model && state.particles);
  const gl::Buffer& particles = *state.particles;
  assert(particles.bytes() >= std::uint64_t{particle_stride} * p.model->particle_count());
  const Status ready = p.prepare_targets(width, height);
  if (!ready) return ready;
  const ViewSettings& view = options.view;
  const Camera camera(view.camera, width, height);
  const QuantityRange range = options.range.value_or(default_range(*p.model, view.colour));
  const bool solid = view.draw.solid && p.buffers->has_skin();

  // A solver's last pass named its own next step as reader, not us.
  gl::barrier(gl::Reader::compute_pass | gl::Reader::vertex_draw);
  p.write_frame(options, camera, width, height, range);
  p.prepare_light(state, options);
  glEnable(GL_FRAMEBUFFER_SRGB);
  if (solid) p.draw_thickness(particles);

  p.targets->samples.framebuffer.bind();
  p.colour_map.bind(UNIT_COLOUR_MAP);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);
  p.terrain.draw_solid(p.programs, p.model->terrain, view.camera, camera);
  if (view.draw.solid) p.buffers->posts().draw(p.programs);
  if (draws_balls(view.draw)) p.buffers->balls().draw(p.programs, state);
  p.draw_springs(particles, view.draw, view.colour);
  p.draw_particles(particles, view.draw);
  // Last of what is opaque: only where nothing else stands.
  p.nothing.bind();
  glUseProgram(p.programs.sky.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  p.terrain.draw_far_glass(p.programs, p.model->terrain);
  if (solid) {
    p.draw_jelly(particles, view, JellySide::far);
    p.targets->picture.framebuffer.copy_colour_from(p.targets->samples.framebuffer);
    p.targets->behind.framebuffer.copy_colour_from(p.targets->picture.framebuffer);
    p.targets->samples.framebuffer.bind();
    p.draw_jelly(particles, view, JellySide::near);
  }
  p.terrain.draw_before_bodies(p.programs, p.model->terrain, view.camera, camera);
  p.targets->picture.framebuffer.copy_colour_from(p.targets->samples.framebuffer);
  const Status written = p.overlay.draw(p.targets->picture.framebuffer, options.text,
                                        options.legend ? legend_for(view, range) : Legend{});
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return written;
}

const gl::Framebuffer& Renderer::picture() const {
  assert(parts_->targets);
  return parts_->targets->picture.framebuffer;
}

void Renderer::present(std::uint32_t framebuffer, int width, int height, int left, int bottom) const {
  assert(parts_->targets);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(left, bottom, width, height);
  parts_->targets->picture.colour.bind(UNIT_FRAME);
  parts_->nothing.bind();
  glUseProgram(parts_->programs.present.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glUseProgram(0);
  glBindVertexArray(0);
}

std::vector<Vec3> Renderer::normals() const {
  std::vector<Vec3> result;
  for (const auto& n :
       parts_->buffers->normals().download_items<std::array<float, 4>>(parts_->buffers->particle_count()))
    result.push_back({static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])});
  return result;
}

}  // namespace aspic
