#include "render/programs.h"

namespace aspic {

Result<RenderPrograms> RenderPrograms::create(gl::Context& context, const gl::ShaderLibrary& library) {
  RenderPrograms p;
  Status status;
  const auto take = [&](gl::Program& into, Result<gl::Program> made) {
    if (!status) return;
    if (made)
      into = std::move(*made);
    else
      status = made.error();
  };
  const auto kernel = [&](gl::Program& into, std::string_view path) {
    if (status) take(into, gl::Program::compute(context, library, path));
  };
  const auto drawing = [&](gl::Program& into, const gl::GraphicsStages& stages,
                           std::span<const gl::Define> defines = {}) {
    if (status) take(into, gl::Program::graphics(context, library, stages, defines));
  };
  const gl::Define plane[] = {{"PLANE", "1"}, {"UNSHADOWED_PLANE", "1"}};
  const gl::Define shadowed_plane[] = {{"PLANE", "1"}, {"SHADOWED_PLANE", "1"}};
  const gl::Define cut_plane[] = {{"PLANE", "1"}, {"UNSHADOWED_PLANE", "1"}, {"CUT_PLANE", "1"}};
  const gl::Define shadowed_cut_plane[] = {{"PLANE", "1"}, {"SHADOWED_PLANE", "1"}, {"CUT_PLANE", "1"}};

  kernel(p.bounds, "render/bounds.comp");
  kernel(p.balls_turn, "render/balls.comp");
  kernel(p.light_boxes, "render/light_boxes.comp");
  kernel(p.normals, "render/normals.comp");
  kernel(p.quantity, "render/quantity.comp");
  drawing(p.light_surface, {"render/light_map.vert", "render/light_map.frag"});
  drawing(p.light_particles,
          {"render/light_points.vert", "render/light_points.frag", "render/light_points.geom"});
  drawing(p.light_springs,
          {"render/light_points.vert", "render/light_points.frag", "render/light_springs.geom"});
  drawing(p.light_balls, {"render/light_balls.vert", "render/light_points.frag", "render/light_points.geom"});
  drawing(p.thickness, {"render/thickness.vert", "render/thickness.frag"});
  drawing(p.jelly_far, {"render/jelly.vert", "render/jelly_far.frag"});
  drawing(p.jelly, {"render/jelly.vert", "render/jelly.frag"});
  drawing(p.particles, {"render/particles.vert", "render/particles.frag", "render/particles.geom"});
  drawing(p.springs, {"render/springs.vert", "render/springs.frag", "render/springs.geom"});
  drawing(p.balls, {"render/balls.vert", "render/balls.frag", "render/balls.geom"});
  drawing(p.rods, {"render/rods.vert", "render/rods.frag"});
  drawing(p.sheet, {"render/jelly.vert", "render/sheet.frag"});
  drawing(p.plane, {"render/terrain.vert", "render/terrain.frag"}, plane);
  drawing(p.shadowed_plane, {"render/terrain.vert", "render/terrain.frag"}, shadowed_plane);
  drawing(p.cut_plane, {"render/terrain.vert", "render/terrain.frag"}, cut_plane);
  drawing(p.shadowed_cut_plane, {"render/terrain.vert", "render/terrain.frag"}, shadowed_cut_plane);
  drawing(p.solid, {"render/terrain.vert", "render/terrain.frag"});
  drawing(p.glass, {"render/terrain.vert", "render/glass.frag"});
  drawing(p.sky, {"render/screen.vert", "render/sky.frag"});
  drawing(p.present, {"render/screen.vert", "render/present.frag"});
  if (!status) return status.error();
  return p;
}

}  // namespace aspic
