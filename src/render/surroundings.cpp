// The surroundings of the bodies in a picture, and which parts of them need not be drawn again.
#include "render/renderer_parts.h"

namespace aspic {
namespace {

/// A thing's pixels may lie this far outside of it: smoothing, and images of half the size [pixels].
constexpr double edge_margin = 4.0;

}  // namespace

void Renderer::Parts::draw_ground(const std::vector<Terrain>& placed, const Camera& camera,
                                  const PictureOptions& options, bool shadows) const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (const auto& c = options.background) glClearBufferfv(GL_COLOR, 0, with_alpha(*c, 0.0).data());
  terrain.draw_solid(programs, placed, options.view.camera, camera, shadows, *targets);
}

/// Whether the picture may begin with the backdrop, which is drawn if need be. Hardware does without: what it
/// would save there is little.
bool Renderer::Parts::prepare_backdrop(const std::vector<Terrain>& placed, const Camera& camera,
                                       const PictureOptions& options) {
  if (!context->info().is_software) return false;
  const bool stays =
      backdrop.stays({drawn_frame, placed, options.background, targets->samples.colour.settings().samples});
  if (!stays && !options.steady) return false;
  if (backdrop.drawn()) return true;
  if (!backdrop.begin(*context, *targets)) return false;
  lights.leave_out(*buffers);
  draw_ground(placed, camera, options, false);
  if (!options.background) fill(programs.sky);
  backdrop.finish();
  return true;
}

/// The picture begins with the backdrop, if it may.
void Renderer::Parts::prepare_surroundings(Drawing& d) {
  glEnable(GL_FRAMEBUFFER_SRGB);
  d.kept = prepare_backdrop(d.terrain, d.camera, d.options);
  d.boxes = d.kept ? changing(d.state, d.camera, d.terrain, d.options) : std::vector{targets->box()};
  if (d.kept) backdrop.put_samples(*targets, d.boxes);
}

/// Whether what is in the state is known here: where other states are, only the device knows.
bool Renderer::Parts::knows(const DeviceState& state) const {
  return state.particles == &uploaded && uploaded_particles.size() == model->particle_count();
}

/// Where translucent bodies are, and as far around them as they bend sight (shaders/render/jelly.frag).
std::vector<gl::PixelBox> Renderer::Parts::around_flesh(const DeviceState& state) const {
  if (!knows(state)) return {targets->box()};
  double reach = 0.0;
  for (const Body& body : model->bodies)
    if (body.style == SurfaceStyle::flesh) reach = std::max(reach, light_reach(body));
  MovingThings things;
  things.particles = uploaded_particles;
  things.particle_radius = 4.0 * particle_radius(buffers->spacing());
  const double shift = 0.22 * reach / static_cast<double>(drawn_frame.eye.w);  // in heights of the picture
  things.margin = edge_margin + shift * static_cast<double>(targets->picture.colour.height());
  return moving_part(drawn_frame, things);
}

/// Where a picture differs from its backdrop.
std::vector<gl::PixelBox> Renderer::Parts::changing(const DeviceState& state, const Camera& camera,
                                                    const std::vector<Terrain>& placed,
                                                    const PictureOptions& options) const {
  MovingThings things;
  if (!knows(state) || !options.arrows.arrows.empty() || options.view.cut.on() || options.view.ground ||
      !terrain.add_changing(placed, options.view.camera, camera, options.shadows, things))
    return {targets->box()};
  things.particles = uploaded_particles;
  things.balls = uploaded_ball_items;
  things.particle_radius = 4.0 * particle_radius(buffers->spacing());
  things.margin = edge_margin;
  things.extents.push_back(rods);
  if (const auto& marks = options.highlight) {
    things.margin += 12.0 * marks->unit;
    if (const auto& pull = marks->pull) {
      Extent& band = things.extents.emplace_back();
      const layout::vec4& end = uploaded_particles[pull->particle].position;
      band.add({pull->anchor.x, pull->anchor.y, pull->anchor.z});
      band.add({end.x, end.y, end.z});
    }
  }
  return moving_part(drawn_frame, things);
}

}  // namespace aspic
