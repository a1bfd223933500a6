#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <span>
#include <utility>

#include "gpu/current.h"
#include "gpu/pass.h"
#include "model/terrain.h"
#include "render/frame_block.h"
#include "render/renderer_parts.h"
#include "render/surroundings.h"

namespace aspic {
namespace {
/// Whether a color shows what a particle's springs do.
bool shows_springs(ViewColor color) {
  return has_scale(color) && color != ViewColor::speed;
}
}  // namespace

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Renderer::~Renderer() = default;
Renderer::Parts::Parts() = default;
Renderer::Parts::~Parts() = default;

FramePolicy* Renderer::policy() const {
  return parts_->policy.get();
}

Result<std::unique_ptr<Renderer>> Renderer::create(gl::Context& context, const RendererOptions& options) {
  const gl::Current here(context);
  ASPIC_CHECK(here.status());
  auto parts = std::make_unique<Parts>();
  parts->context = &context;
  parts->policy = FramePolicy::create(context);
  if (parts->policy) parts->surroundings = std::make_unique<Parts::Surroundings>();
  parts->programs = RenderPrograms::create(context, options.shaders);
  parts->overlay.emplace(context, parts->programs.overlay);
  ASPIC_TRY(parts->terrain, TerrainPainter::create(context));
  ASPIC_TRY(parts->reference_ground, ReferenceGround::create(context, parts->programs.reference_ground));
  ASPIC_TRY(parts->lights, LightMaps::create(context));
  ASPIC_TRY(parts->color_map, gl::Texture::create(context, "color map", {.width = 256, .height = 1}));
  ASPIC_TRY(parts->frame,
            gl::Buffer::create(context, "frame", sizeof(render_layout::Frame), gl::BufferKind::uniform));
  parts->nothing = gl::VertexArray::without_inputs(context);
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  parts->samples = std::clamp(options.samples, 1, static_cast<int>(most));
  return std::unique_ptr<Renderer>(new Renderer(std::move(parts)));
}

Status Renderer::set_model(const Model& model) {
  const gl::Current here(*parts_->context);
  ASPIC_CHECK(here.status());
  parts_->abandon();
  ASPIC_TRY(auto buffers, ModelBuffers::create(*parts_->context, model));
  ASPIC_CHECK(parts_->terrain.set_terrain(*parts_->context, model.terrain));
  parts_->buffers.reset();
  parts_->buffers.emplace(std::move(buffers));
  if (parts_->surroundings) parts_->surroundings->reset(model);
  parts_->lights.hold({});
  parts_->model = &model;
  parts_->drawn_state.reset();
  if (parts_->picker) parts_->picker->forget();
  return {};
}

Status Renderer::Parts::prepare_targets(int width, int height, int wanted_samples) {
  const int count = wanted_samples > 0 ? std::min(wanted_samples, samples) : samples;
  if (targets && targets->image.color.width() == width && targets->image.color.height() == height &&
      targets->samples.color.settings().samples == count)
    return {};
  targets.reset();
  ASPIC_TRY(targets, ImageTargets::create(*context, width, height, count));
  return {};
}

Status Renderer::Parts::prepare_highlight() {
  if (highlight) return {};
  ASPIC_TRY(highlight, HighlightPainter::create(programs.source));
  return {};
}

Status Renderer::Parts::prepare_section() {
  if (!section) section = std::make_unique<SectionPainter>(programs.source);
  return section->prepare(*model);
}

Status Renderer::Parts::draw_arrows(const ViewSettings& view, const ArrowSet& set) {
  if (set.arrows.empty()) return {};
  if (!arrows) arrows = std::make_unique<ArrowPainter>(programs.source);
  const Status drawn = arrows->draw(view, set);
  glDepthFunc(GL_LEQUAL);
  return drawn;
}

void Renderer::Parts::bind_frame(const render_layout::Frame& block) {
  frame.upload_items(std::span(&block, 1));
  frame.bind(gl::BufferKind::uniform, BINDING_FRAME);
}

void Renderer::Parts::prepare_light(const DeviceState& state, const ImageOptions& options) {
  const ViewSettings& view = options.view;
  // Where other states come from, only the device knows whether they are the same.
  std::optional<LightLook> look;
  if (options.shadows && state.particles == &uploaded)
    look = {uploads, state.step, view.draw, view.cut, options.coarse_skin};
  const bool held = lights.hold(look);
  if (!held) {
    buffers->compute_light_boxes(programs, state);
    mark(FramePass::bounds);
  }
  if (view.draw.solid) buffers->compute_skin(programs, *state.particles);
  mark(FramePass::skin);
  if (held) {
    lights.bind(*buffers);
    return;
  }
  if (options.shadows)
    lights.render(programs, *buffers, state, view);
  else
    lights.leave_out(*buffers);
  mark(FramePass::light_maps);
}

/// After compute_quantity() of a view that follows the image.
QuantityRange Renderer::Parts::measured_range(const ViewSettings& view) const {
  const bool springs = draws_springs(drawn_springs(view)) || (view.draw.solid && has(SurfaceStyle::cords));
  return range_for(*model, view, buffers->extremes(springs && shows_springs(view.color)));
}

void Renderer::Parts::prepare_scale(const DeviceState& state, const ImageOptions& options) {
  const ViewSettings& view = options.view;
  const ScaleMap wanted = chosen_map(view);
  if (std::exchange(uploaded_map, wanted) != wanted) color_map.upload(color_map_texels(wanted));
  if (!has_scale(view.color)) return;
  buffers->compute_quantity(programs, state);
  if (!follows_image(view) || options.range) return;
  range = measured_range(view);
  drawn_frame.quantity_range = quantity_scale(range);
  bind_frame(drawn_frame);
}

/// Everything is ready for the steps of an image, and the image before is still there if that is not to
/// be.
Status Renderer::Parts::start(int width, int height, const DeviceState& state, const ImageOptions& options) {
  assert(model && state.particles && state.particles->context() == context);
  assert(state.particles->bytes() >= sizeof(layout::Particle) * model->particle_count());
  const ViewSettings& view = options.view;
  programs.start(*model, view, options.shadows);
  ASPIC_CHECK(prepare_targets(width, height, options.samples));
  if (options.highlight) ASPIC_CHECK(prepare_highlight());
  if (view.cut.on()) ASPIC_CHECK(prepare_section());
  if (has(SurfaceStyle::cords) || draws_springs(drawn_springs(view)))
    ASPIC_CHECK(buffers->prepare_lines(*context, *model));
  if (shows_springs(view.color)) ASPIC_CHECK(buffers->prepare_incident(*context, *model, state));
  buffers->set_rest_lengths(*model, state.step, options.channels, view.color == ViewColor::actuation);
  buffers->use_coarse_skin(options.coarse_skin && !view.cut.on());
  const Camera camera(view.camera, width, height);
  if (!options.ball_turns.empty()) buffers->set_ball_turns(options.ball_turns, state.step);
  range = options.range.value_or(range_for(*model, view, {}));
  // A solver's last pass named its own next step as reader, not us.
  gl::barrier(gl::ReadBy::compute_pass | gl::ReadBy::vertex_draw);
  drawn_frame = frame_block(*model, camera, width, height,
                            {view, range, has(SurfaceStyle::flesh), options.shadows, state.step,
                             section_depth(view.cut, buffers->spacing())});
  drawn_state = state;
  drawn_view = view;
  drawing.emplace(Drawing{state, options, camera, {}, {}, {}, 0, false});
  for (const Terrain& t : model->terrain)
    if (!options.background && view.terrain)
      drawing->terrain.push_back(terrain_at(t, model->simulation.timestep, state.step));
  if (profiler) profiler->begin();
  bind_frame(drawn_frame);
  return {};
}

/// The image is complete.
Status Renderer::Parts::finish() {
  if (profiler) profiler->end();
  const Status written = drawing->written ? programs.source->take_refused() : drawing->written;
  drawing.reset();
  earlier.reset();
  leave();
  return written;
}

/// Gives up the image that is being drawn.
void Renderer::Parts::abandon() {
  drawing.reset();
  if (earlier) targets = std::move(earlier);
  earlier.reset();
}

Status Renderer::draw(int width, int height, const DeviceState& state, const ImageOptions& options) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  p.abandon();
  ASPIC_CHECK(p.start(width, height, state, options));
  for (const Parts::Step& step : Parts::steps()) {
    step.draw(p, *p.drawing);
    if (step.pass) p.mark(*step.pass);
  }
  return p.finish();
}

Status Renderer::begin(int width, int height, const DeviceState& state, const ImageOptions& options) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  p.abandon();
  std::swap(p.earlier, p.targets);
  const Status started = p.start(width, height, state, options);
  if (!started) p.abandon();
  return started;
}

Result<bool> Renderer::proceed() {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  assert(p.drawing);
  Drawing& d = *p.drawing;
  const std::span<const Parts::Step> steps = Parts::steps();
  p.resume();
  steps[d.step].draw(p, d);
  p.leave();
  if (p.policy) p.policy->wait();
  if (++d.step < steps.size()) return false;
  ASPIC_CHECK(p.finish());
  return true;
}

Result<std::uint64_t> Renderer::request_pick(const PickPlace& place) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  assert(p.drawn_state);
  if (!p.picker) {
    ASPIC_TRY(p.picker, Picker::create(p.programs.source));
  }
  p.picker->submit(++p.picks, *p.model, *p.buffers, *p.drawn_state, p.drawn_view,
                   p.drawn_view.cut.on() ? p.section.get() : nullptr, p.drawn_frame, place);
  ASPIC_CHECK(p.programs.source->take_refused());
  return p.picks;
}

PickAnswer Renderer::picked() const {
  const gl::Current here(*parts_->context);
  return parts_->picker && here.status() ? parts_->picker->answer() : PickAnswer{};
}

Result<QuantityRange> Renderer::range_of(const DeviceState& state, const ViewSettings& view,
                                         std::span<const double> channels) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  const QuantityRange alone = range_for(*p.model, view, {});
  if (!follows_image(view)) return alone;
  if (shows_springs(view.color)) ASPIC_CHECK(p.buffers->prepare_incident(*p.context, *p.model, state));
  p.buffers->set_rest_lengths(*p.model, state.step, channels, view.color == ViewColor::actuation);
  gl::barrier(gl::ReadBy::compute_pass | gl::ReadBy::vertex_draw);
  const FrameContent content = {view, alone, p.has(SurfaceStyle::flesh), false, state.step, 0.0f};
  p.bind_frame(frame_block(*p.model, Camera(view.camera, 1, 1), 1, 1, content));
  p.buffers->compute_quantity(p.programs, state);
  ASPIC_CHECK(p.programs.source->take_refused());
  return p.measured_range(view);
}

QuantityRange Renderer::range() const {
  return parts_->range;
}

const gl::Framebuffer& Renderer::image() const {
  return parts_->last().image.framebuffer;
}

void Renderer::present(std::uint32_t framebuffer, int width, int height, int left, int bottom) const {
  const gl::Current here(*parts_->context);
  if (!here.status()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(left, bottom, width, height);
  parts_->last().image.color.bind(UNIT_FRAME);
  parts_->fill(parts_->programs.present);
  glUseProgram(0);
  glBindVertexArray(0);
}

void Renderer::present_ghost(const Color& background, std::uint32_t framebuffer, int width, int height,
                             int left, int bottom) const {
  const gl::Current here(*parts_->context);
  if (!here.status()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(left, bottom, width, height);
  parts_->last().image.color.bind(UNIT_FRAME);
  parts_->programs.ghost.set(LOCATION_BASE_COLOR, with_alpha(background, 1.0));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  parts_->fill(parts_->programs.ghost);
  glDisable(GL_BLEND);
  glUseProgram(0);
  glBindVertexArray(0);
}

Status Renderer::present_highlight(const HighlightOptions& options, std::uint32_t framebuffer, int width,
                                   int height, int left, int bottom) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  assert(p.drawn_state && width > 0 && height > 0);
  ASPIC_CHECK(p.prepare_highlight());
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(left, bottom, width, height);
  // Marks end where the image does.
  glEnable(GL_SCISSOR_TEST);
  glScissor(left, bottom, width, height);
  render_layout::Frame frame = p.drawn_frame;
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  frame.viewport = glm::vec4(w, h, 1.0f / w, 1.0f / h);
  const Status drawn =
      p.highlight->draw_over(*p.buffers, *p.drawn_state->particles, p.drawn_view.draw, options, frame);
  glDisable(GL_SCISSOR_TEST);
  glUseProgram(0);
  glBindVertexArray(0);
  return drawn ? p.programs.source->take_refused() : drawn;
}

void Renderer::set_profiling(bool on) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  if (on == (p.profiler != nullptr) || !here.status()) return;
  p.profiler.reset();
  if (on)
    p.profiler = std::make_unique<gl::PassProfiler>(
        *p.context, frame_pass_names(), p.policy ? gl::PassStamps::waiting : gl::PassStamps::queued);
}

std::vector<gl::PassTime> Renderer::pass_times() {
  const gl::Current here(*parts_->context);
  return parts_->profiler && here.status() ? parts_->profiler->times() : std::vector<gl::PassTime>();
}

std::vector<Vec3> Renderer::normals() const {
  const gl::Current here(*parts_->context);
  if (!here.status()) return {};
  std::vector<Vec3> result;
  const gl::Buffer& skin = parts_->buffers->skin();
  const auto count = static_cast<std::size_t>(skin.bytes()) / sizeof(render_layout::SkinVertex);
  for (const render_layout::SkinVertex& v : skin.download_items<render_layout::SkinVertex>(count))
    result.push_back(
        {static_cast<double>(v.normal.x), static_cast<double>(v.normal.y), static_cast<double>(v.normal.z)});
  return result;
}

}  // namespace aspic
