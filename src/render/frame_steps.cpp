// An image step by step, at once or with other work in between.
#include "render/renderer_parts.h"
#include "render/surroundings.h"

namespace aspic {

/// What most steps expect.
void Renderer::Parts::ready_to_draw() const {
  glEnable(GL_FRAMEBUFFER_SRGB);
  targets->samples.framebuffer.bind();
  color_map.bind(UNIT_COLOR_MAP);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
}

/// The same, and what other work may have changed since the step before.
void Renderer::Parts::resume() {
  bind_frame(drawn_frame);
  if (drawing->options.shadows)
    lights.bind(*buffers);
  else
    lights.leave_out(*buffers);
  targets->thickness.color.bind(UNIT_THICKNESS);
  ready_to_draw();
}

/// As OpenGL starts.
void Renderer::Parts::leave() const {
  glDisable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

std::span<const Renderer::Parts::Step> Renderer::Parts::steps() {
  static constexpr Step all[] = {
      {FramePass::quantity, [](Parts& p, Drawing& d) { p.prepare_scale(d.state, d.options); }},
      {FramePass::backdrop, [](Parts& p, Drawing& d) { p.prepare_surroundings(d); }},
      // Bounds, skin and light maps, as far as they are not held.
      {std::nullopt,
       [](Parts& p, Drawing& d) {
         glDisable(GL_FRAMEBUFFER_SRGB);
         p.prepare_light(d.state, d.options);
         glEnable(GL_FRAMEBUFFER_SRGB);
       }},
      {FramePass::thickness,
       [](Parts& p, Drawing& d) {
         if (p.draws_flesh(d)) p.bodies(d).draw_thickness();
         p.ready_to_draw();
       }},
      {FramePass::surroundings,
       [](Parts& p, Drawing& d) {
         if (!d.kept)
           p.draw_ground(d, d.options.shadows);
         else if (d.options.shadows)
           p.terrain.draw_shadows(p.programs, d.terrain, d.options.view.camera, d.camera, *p.targets);
       }},
      {FramePass::balls, [](Parts& p, Drawing& d) { p.bodies(d).draw_rods_and_balls(); }},
      {FramePass::springs, [](Parts& p, Drawing& d) { p.bodies(d).draw_springs(); }},
      {FramePass::particles,
       [](Parts& p, Drawing& d) {
         p.bodies(d).draw_particles();
         p.bodies(d).draw_section();
       }},
      // The last opaque part: only where there is nothing else.
      {FramePass::sky,
       [](Parts& p, Drawing& d) {
         if (!d.kept && !d.options.background) p.fill(p.programs.sky);
       }},
      {FramePass::sheets,
       [](Parts& p, Drawing& d) {
         if (d.options.view.draw.solid && p.has(SurfaceStyle::sheet)) p.bodies(d).draw_sheets();
       }},
      {FramePass::far_glass,
       [](Parts& p, Drawing& d) {
         p.terrain.draw_far_glass(p.programs, d.terrain);
         if (!d.options.background) p.reference_ground.draw(d.options.view, d.camera);
         p.bodies(d).draw_cords();
       }},
      {FramePass::jelly_far,
       [](Parts& p, Drawing& d) {
         if (p.draws_flesh(d)) p.bodies(d).draw_jelly(JellySide::far);
       }},
      {FramePass::behind,
       [](Parts& p, Drawing& d) {
         if (!p.draws_flesh(d)) return;
         const auto& kept = p.surroundings;
         halve_samples(p.programs, p.nothing, *p.targets,
                       kept ? kept->around_flesh(p, d.state) : std::vector{p.targets->box()});
         p.targets->samples.framebuffer.bind();
       }},
      {FramePass::jelly,
       [](Parts& p, Drawing& d) {
         if (!p.draws_flesh(d)) return;
         p.bodies(d).draw_jelly(JellySide::near);
         p.bodies(d).draw_cords();
       }},
      {FramePass::glass,
       [](Parts& p, Drawing& d) {
         const ViewSettings& view = d.options.view;
         if (!d.options.background) p.reference_ground.draw(view, d.camera);
         p.terrain.draw_before_bodies(p.programs, d.terrain, view.camera, d.camera);
       }},
      {FramePass::marks,
       [](Parts& p, Drawing& d) {
         const ViewSettings& view = d.options.view;
         d.written = p.draw_arrows(view, d.options.arrows);
         if (d.written && d.options.highlight)
           d.written =
               p.highlight->draw_within(*p.buffers, *d.state.particles, view.draw, *d.options.highlight);
       }},
      {FramePass::resolve,
       [](Parts& p, Drawing& d) {
         if (d.kept) p.surroundings->put_image(*p.targets);
         resolve_samples(*p.targets, d.boxes);
       }},
      {FramePass::text,
       [](Parts& p, Drawing& d) {
         if (!d.written) return;
         const ImageOptions& o = d.options;
         std::vector<Legend> legends;
         if (o.legend) legends = {legend_for(o.view, p.range), arrow_legend(o.view, o.arrows)};
         d.written = p.overlay->draw(p.targets->image.framebuffer, o.text, legends,
                                     o.axes && o.view.axes ? &d.camera : nullptr, o.text_height);
       }},
  };
  return all;
}

}  // namespace aspic
