#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>

#include "device/particles.h"
#include "gpu/pass.h"
#include "model/terrain.h"
#include "render/frame_block.h"
#include "render/light_maps.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "render/targets.h"
#include "render/terrain_painter.h"

namespace aspic {
namespace {
/// The walls of a translucent body that face away from the eye, or towards it.
enum class JellySide { far, near };

/// Cords of nets.
constexpr Colour net_colour = {0.98f, 0.98f, 0.98f};

/// How deep light reaches into a body [m], as a share of its size.
constexpr double reach_share = 0.30;

std::array<float, 4> with(const Colour& c, double w) {
  return {c[0], c[1], c[2], static_cast<float>(w)};
}

/// Whether a colour shows what a particle's springs do.
bool shows_springs(ViewColour colour) {
  return colour == ViewColour::strain || colour == ViewColour::force;
}

/// Uploads into a buffer that is made, or made larger, as needed.
template <class T>
Status refill(gl::Context& context, gl::Buffer& buffer, const char* name, const std::vector<T>& items) {
  const std::uint64_t bytes = sizeof(T) * items.size();
  if (buffer.id() == 0 || buffer.bytes() < bytes) {
    ASPIC_TRY(buffer, gl::Buffer::create(context, name, bytes));
  }
  buffer.upload_items(items);
  return {};
}
}  // namespace

struct Renderer::Parts {
  gl::Context* context = nullptr;
  RenderPrograms programs;
  std::optional<OverlayPainter> overlay;
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
  gl::ShaderLibrary shaders;
  // Of the picture last drawn, for what is asked about it afterwards.
  std::optional<DeviceState> drawn_state;
  render_layout::Frame drawn_frame = {};
  DrawSettings drawn_settings;
  std::unique_ptr<Picker> picker;
  std::unique_ptr<HighlightPainter> highlight;
  std::uint64_t picks = 0;

  Status prepare_targets(int width, int height, int wanted_samples);
  Status prepare_highlight();
  void bind_frame(const render_layout::Frame& block);
  void prepare_light(const DeviceState& state, const PictureOptions& options);
  void draw_thickness(const gl::Buffer& particles) const;
  void draw_rods_and_balls(const DeviceState& state, const DrawSettings& draw) const;
  void draw_particles(const gl::Buffer& particles, const DrawSettings& draw) const;
  void draw_springs(const gl::Buffer& particles, const DrawSettings& draw, ViewColour mode) const;
  void draw_sheets(const gl::Buffer& particles, const ViewSettings& view) const;
  void draw_jelly(const gl::Buffer& particles, const ViewSettings& view, JellySide side) const;
  void draw_parts(const gl::Program& program, const gl::Buffer& particles, const ViewSettings& view,
                  SurfaceStyle style) const;
  /// The skins of bodies of a style, each after prepare(body).
  template <class Prepare>
  void draw_skins(const gl::Buffer& particles, SurfaceStyle style, const Prepare& prepare) const {
    const gl::VertexArray skin = buffers->skin_array(particles);
    skin.bind();
    for (std::size_t i = 0; i < buffers->parts().size(); ++i) {
      if (buffers->parts()[i].index_count == 0 || model->bodies[i].style != style) continue;
      prepare(i);
      draw_triangles(buffers->parts()[i]);
    }
  }
  /// The whole picture by one program.
  void fill(const gl::Program& program) const {
    nothing.bind();
    glUseProgram(program.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  bool has(SurfaceStyle style) const {
    return std::ranges::any_of(model->bodies, [=](const Body& b) { return b.style == style; });
  }
};

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(gl::Context& context, const RendererOptions& options) {
  auto parts = std::make_unique<Parts>();
  parts->context = &context;
  parts->shaders = options.shaders;
  ASPIC_TRY(parts->programs, RenderPrograms::create(context, options.shaders));
  ASPIC_TRY(parts->overlay, OverlayPainter::create(context, options.shaders));
  ASPIC_TRY(parts->terrain, TerrainPainter::create(context));
  ASPIC_TRY(parts->lights, LightMaps::create(context));
  ASPIC_TRY(parts->colour_map, gl::Texture::create(context, "colour map", {.width = 256, .height = 1}));
  parts->colour_map.upload(colour_map_texels());
  ASPIC_TRY(parts->frame,
            gl::Buffer::create(context, "frame", sizeof(render_layout::Frame), gl::BufferKind::uniform));
  parts->nothing = gl::VertexArray::create({});
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  parts->samples = std::clamp(options.samples, 1, static_cast<int>(most));
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

Status Renderer::set_model(const Model& model) {
  ASPIC_TRY(auto buffers, ModelBuffers::create(*parts_->context, model));
  ASPIC_CHECK(parts_->terrain.set_terrain(*parts_->context, model.terrain));
  parts_->buffers.reset();
  parts_->buffers.emplace(std::move(buffers));
  parts_->model = &model;
  parts_->drawn_state.reset();
  if (parts_->picker) parts_->picker->forget();
  return {};
}

Result<DeviceState> Renderer::upload(const State& state) {
  Parts& p = *parts_;
  assert(p.model);
  ASPIC_CHECK(refill(*p.context, p.uploaded, "particles to draw", packed_particles(*p.model, state)));
  ASPIC_CHECK(refill(*p.context, p.uploaded_balls, "balls to draw", packed_balls(*p.model, state)));
  return DeviceState{&p.uploaded, &p.uploaded_balls, 0, state.step, nullptr};
}

Status Renderer::Parts::prepare_targets(int width, int height, int wanted_samples) {
  const int count = wanted_samples > 0 ? std::min(wanted_samples, samples) : samples;
  if (targets && targets->picture.colour.width() == width && targets->picture.colour.height() == height &&
      targets->samples.colour.settings().samples == count)
    return {};
  targets.reset();
  ASPIC_TRY(targets, PictureTargets::create(*context, width, height, count));
  return {};
}

Status Renderer::Parts::prepare_highlight() {
  if (highlight) return {};
  ASPIC_TRY(highlight, HighlightPainter::create(*context, shaders));
  return {};
}

void Renderer::Parts::bind_frame(const render_layout::Frame& block) {
  frame.upload_items(std::span(&block, 1));
  frame.bind(gl::BufferKind::uniform, BINDING_FRAME);
}

void Renderer::Parts::prepare_light(const DeviceState& state, const PictureOptions& options) {
  const gl::Buffer& particles = *state.particles;
  buffers->compute_light_boxes(programs, state);
  if (options.view.draw.solid && buffers->has_skin()) buffers->compute_normals(programs, particles);
  if (options.view.colour >= ViewColour::strain) buffers->compute_quantity(programs, state);
  if (options.shadows)
    lights.render(programs, *buffers, state, options.view.draw);
  else
    lights.leave_out(*buffers);
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
  draw_skins(particles, SurfaceStyle::flesh, [](std::size_t) {});
  glDisable(GL_BLEND);
  targets->thickness.colour.bind(UNIT_THICKNESS);
}

void Renderer::Parts::draw_rods_and_balls(const DeviceState& state, const DrawSettings& draw) const {
  programs.rods.set(LOCATION_BASE_COLOUR, std::array{0.94f, 0.94f, 0.94f, 1.0f});
  glUseProgram(programs.rods.id());
  if (draw.solid) buffers->rods().draw();
  if (!draws_balls(draw)) return;
  glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  buffers->balls().draw(programs.balls, state);
  glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
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
    draw_lines(run);
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
  draw_parts(program, particles, view, SurfaceStyle::flesh);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glCullFace(GL_BACK);
  glDisable(GL_CULL_FACE);
}

void Renderer::Parts::draw_sheets(const gl::Buffer& particles, const ViewSettings& view) const {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  // Springs and particles lie in the surface: it gives way to them.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0f, 1.0f);
  colour_map.bind(UNIT_COLOUR_MAP);
  draw_parts(programs.sheet, particles, view, SurfaceStyle::sheet);
  glPolygonOffset(0.0f, 0.0f);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_BLEND);
}

void Renderer::Parts::draw_parts(const gl::Program& program, const gl::Buffer& particles,
                                 const ViewSettings& view, SurfaceStyle style) const {
  glUseProgram(program.id());
  draw_skins(particles, style, [&](std::size_t body) {
    const Colour colour = view.colour == ViewColour::material ? body_colour(body) : neutral_body_colour();
    program.set(LOCATION_BASE_COLOUR, with(colour, reach_share * model->bodies[body].size));
  });
}

Status Renderer::draw(int width, int height, const DeviceState& state, const PictureOptions& options) {
  Parts& p = *parts_;
  assert(p.model && state.particles);
  const gl::Buffer& particles = *state.particles;
  assert(particles.bytes() >= sizeof(layout::Particle) * p.model->particle_count());
  const ViewSettings& view = options.view;
  ASPIC_CHECK(p.prepare_targets(width, height, options.samples));
  if (options.highlight) ASPIC_CHECK(p.prepare_highlight());
  if (p.has(SurfaceStyle::cords) || draws_springs(view.draw))
    ASPIC_CHECK(p.buffers->prepare_lines(*p.context, *p.model));
  if (shows_springs(view.colour)) ASPIC_CHECK(p.buffers->prepare_incident(*p.context, *p.model, state));
  p.buffers->use_coarse_skin(options.coarse_skin);
  const Camera camera(view.camera, width, height);
  const QuantityRange range = options.range.value_or(default_range(*p.model, view.colour));
  const bool flesh = p.has(SurfaceStyle::flesh), solid = view.draw.solid && flesh;
  // A solver's last pass named its own next step as reader, not us.
  gl::barrier(gl::ReadBy::compute_pass | gl::ReadBy::vertex_draw);
  p.drawn_frame =
      frame_block(*p.model, camera, width, height, {view, range, flesh, options.shadows, state.step});
  std::vector<Terrain> terrain;
  for (const Terrain& t : p.model->terrain)
    if (!options.background) terrain.push_back(terrain_at(t, p.model->simulation.timestep, state.step));
  p.drawn_state = state;
  p.drawn_settings = view.draw;
  p.bind_frame(p.drawn_frame);
  p.prepare_light(state, options);
  glEnable(GL_FRAMEBUFFER_SRGB);
  if (solid) p.draw_thickness(particles);
  p.targets->samples.framebuffer.bind();
  p.colour_map.bind(UNIT_COLOUR_MAP);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (const auto& c = options.background) glClearBufferfv(GL_COLOR, 0, with(*c, 1.0).data());
  p.terrain.draw_solid(p.programs, terrain, view.camera, camera, options.shadows);
  p.draw_rods_and_balls(state, view.draw);
  p.draw_springs(particles, view.draw, view.colour);
  p.draw_particles(particles, view.draw);
  // The last opaque part: only where there is nothing else.
  if (!options.background) p.fill(p.programs.sky);
  if (view.draw.solid && p.has(SurfaceStyle::sheet)) p.draw_sheets(particles, view);
  p.terrain.draw_far_glass(p.programs, terrain);
  if (solid) {
    p.draw_jelly(particles, view, JellySide::far);
    p.targets->picture.framebuffer.copy_colour_from(p.targets->samples.framebuffer);
    p.targets->behind.framebuffer.copy_colour_from(p.targets->picture.framebuffer);
    p.targets->samples.framebuffer.bind();
    p.draw_jelly(particles, view, JellySide::near);
  }
  p.terrain.draw_before_bodies(p.programs, terrain, view.camera, camera);
  Status written;
  if (options.highlight)
    written = p.highlight->draw_within(*p.buffers, particles, view.draw, *options.highlight);
  p.targets->picture.framebuffer.copy_colour_from(p.targets->samples.framebuffer);
  if (written)
    written = p.overlay->draw(p.targets->picture.framebuffer, options.text,
                              options.legend ? legend_for(view, range) : Legend{}, options.text_height);
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return written;
}

Result<std::uint64_t> Renderer::request_pick(const PickPlace& place) {
  Parts& p = *parts_;
  assert(p.drawn_state);
  if (!p.picker) {
    ASPIC_TRY(p.picker, Picker::create(*p.context, p.shaders));
  }
  p.picker->submit(++p.picks, *p.model, *p.buffers, *p.drawn_state, p.drawn_settings, p.drawn_frame, place);
  return p.picks;
}

PickAnswer Renderer::picked() const {
  return parts_->picker ? parts_->picker->answer() : PickAnswer{};
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
  parts_->fill(parts_->programs.present);
  glUseProgram(0);
  glBindVertexArray(0);
}

Status Renderer::present_highlight(const HighlightOptions& options, std::uint32_t framebuffer, int width,
                                   int height, int left, int bottom) {
  Parts& p = *parts_;
  assert(p.drawn_state && width > 0 && height > 0);
  ASPIC_CHECK(p.prepare_highlight());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(left, bottom, width, height);
  // Marks end where the picture does.
  glEnable(GL_SCISSOR_TEST);
  glScissor(left, bottom, width, height);
  render_layout::Frame frame = p.drawn_frame;
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  frame.viewport = glm::vec4(w, h, 1.0f / w, 1.0f / h);
  const Status drawn =
      p.highlight->draw_over(*p.buffers, *p.drawn_state->particles, p.drawn_settings, options, frame);
  glDisable(GL_SCISSOR_TEST);
  glUseProgram(0);
  glBindVertexArray(0);
  return drawn;
}

std::vector<Vec3> Renderer::normals() const {
  std::vector<Vec3> result;
  for (const auto& n :
       parts_->buffers->normals().download_items<std::array<float, 4>>(parts_->buffers->particle_count()))
    result.push_back({static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])});
  return result;
}

}  // namespace aspic
