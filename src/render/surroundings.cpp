// The surroundings of the bodies in an image, and which parts of them need not be drawn again.
#include "render/surroundings.h"

#include <algorithm>

#include "render/rods.h"

namespace aspic {
namespace {

/// A thing's pixels may lie this far outside of it: smoothing, and images of half the size [pixels].
constexpr double edge_margin = 4.0;

/// How far from particles something may be drawn [m]: their own images, and meshes, which reach half a
/// cell, stretched, out of the cells that they hang on.
double drawn_around(const Model& model, double spacing) {
  const bool mesh = std::ranges::any_of(model.bodies, [](const Body& body) { return !body.skin.empty(); });
  return std::max(4.0 * particle_radius(spacing), mesh ? 1.5 * spacing : 0.0);
}

}  // namespace

void Renderer::Parts::draw_ground(const Drawing& d, bool shadows) const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glClear(GL_DEPTH_BUFFER_BIT);
  if (const auto& c = d.options.background) glClearBufferfv(GL_COLOR, 0, with_alpha(*c, 0.0).data());
  terrain.draw_solid(programs, d.terrain, d.options.view.camera, d.camera, shadows, *targets);
}

/// The image begins with what is kept, if it may.
void Renderer::Parts::prepare_surroundings(Drawing& d) {
  glEnable(GL_FRAMEBUFFER_SRGB);
  d.kept = surroundings && surroundings->prepare(*this, d);
  d.boxes = d.kept ? surroundings->changing(*this, d) : std::vector{targets->box()};
  if (d.kept) surroundings->put_samples(*targets, d.boxes);
}

bool Renderer::Parts::knows(const DeviceState& state) const {
  return state.particles == &uploaded && uploaded_particles.size() == model->particle_count();
}

void Renderer::Parts::Surroundings::reset(const Model& another) {
  rods_ = extent_of(rod_mesh(another));
  backdrop_.forget();
}

bool Renderer::Parts::Surroundings::prepare(Parts& p, const Drawing& d) {
  const bool stays = backdrop_.stays(
      {p.drawn_frame, d.terrain, d.options.background, p.targets->samples.color.settings().samples});
  if (!stays && !d.options.steady) return false;
  if (backdrop_.drawn()) return true;
  if (!backdrop_.begin(*p.context, *p.targets)) return false;
  p.lights.leave_out(*p.buffers);
  p.draw_ground(d, false);
  if (!d.options.background) p.fill(p.programs.sky);
  backdrop_.finish();
  return true;
}

std::vector<gl::PixelBox> Renderer::Parts::Surroundings::around_flesh(const Parts& p,
                                                                      const DeviceState& state) const {
  if (!p.knows(state)) return {p.targets->box()};
  double reach = 0.0;
  for (const Body& body : p.model->bodies)
    if (body.style == SurfaceStyle::flesh) reach = std::max(reach, light_reach(body));
  MovingThings things;
  things.particles = p.uploaded_particles;
  things.particle_radius = drawn_around(*p.model, p.buffers->spacing());
  const double shift = 0.22 * reach / static_cast<double>(p.drawn_frame.eye.w);  // in heights of the image
  things.margin = edge_margin + shift * static_cast<double>(p.targets->image.color.height());
  return moving_part(p.drawn_frame, things);
}

std::vector<gl::PixelBox> Renderer::Parts::Surroundings::changing(const Parts& p, const Drawing& d) const {
  const ImageOptions& options = d.options;
  MovingThings things;
  if (!p.knows(d.state) || !options.arrows.arrows.empty() || options.view.cut.on() || options.view.ground ||
      !p.terrain.add_changing(d.terrain, options.view.camera, d.camera, options.shadows, things))
    return {p.targets->box()};
  things.particles = p.uploaded_particles;
  things.balls = p.uploaded_ball_items;
  things.particle_radius = drawn_around(*p.model, p.buffers->spacing());
  things.margin = edge_margin;
  things.extents.push_back(rods_);
  if (const auto& marks = options.highlight) {
    things.margin += 12.0 * marks->unit;
    if (const auto& pull = marks->pull) {
      Extent& band = things.extents.emplace_back();
      const layout::vec4& end = p.uploaded_particles[pull->particle].position;
      band.add({pull->anchor.x, pull->anchor.y, pull->anchor.z});
      band.add({end.x, end.y, end.z});
    }
  }
  return moving_part(p.drawn_frame, things);
}

}  // namespace aspic
