#include "render/programs.h"

#include <string>

namespace aspic {

Result<RenderPrograms> RenderPrograms::create(gl::Context& context, const gl::ShaderLibrary& library) {
  RenderPrograms p;
  const auto kernel = [&](std::string_view path) { return gl::Program::compute(context, library, path); };
  const auto drawing = [&](const gl::GraphicsStages& stages, std::span<const gl::Define> defines = {}) {
    return gl::Program::graphics(context, library, stages, defines);
  };
  ASPIC_TRY(p.bounds, kernel("render/bounds.comp"));
  ASPIC_TRY(p.balls_turn, kernel("render/balls.comp"));
  ASPIC_TRY(p.light_boxes, kernel("render/light_boxes.comp"));
  ASPIC_TRY(p.skin, kernel("render/skin.comp"));
  ASPIC_TRY(p.mesh_skin, kernel("render/mesh_skin.comp"));
  ASPIC_TRY(p.mesh_normals, kernel("render/mesh_normals.comp"));
  ASPIC_TRY(p.quantity, kernel("render/quantity.comp"));
  ASPIC_TRY(p.light_surface, drawing({"render/light_map.vert", "render/light_map.frag"}));
  ASPIC_TRY(p.light_particles,
            drawing({"render/light_points.vert", "render/light_points.frag", "render/light_points.geom"}));
  ASPIC_TRY(p.light_springs,
            drawing({"render/light_points.vert", "render/light_points.frag", "render/light_springs.geom"}));
  ASPIC_TRY(p.light_balls,
            drawing({"render/light_balls.vert", "render/light_points.frag", "render/light_points.geom"}));
  ASPIC_TRY(p.thickness, drawing({"render/thickness.vert", "render/thickness.frag"}));
  ASPIC_TRY(p.jelly_far, drawing({"render/jelly.vert", "render/jelly_far.frag"}));
  ASPIC_TRY(p.jelly, drawing({"render/jelly.vert", "render/jelly.frag"}));
  ASPIC_TRY(p.particles,
            drawing({"render/particles.vert", "render/particles.frag", "render/particles.geom"}));
  ASPIC_TRY(p.springs, drawing({"render/springs.vert", "render/springs.frag", "render/springs.geom"}));
  ASPIC_TRY(p.balls, drawing({"render/balls.vert", "render/balls.frag", "render/balls.geom"}));
  ASPIC_TRY(p.rods, drawing({"render/rods.vert", "render/rods.frag"}));
  ASPIC_TRY(p.sheet, drawing({"render/jelly.vert", "render/sheet.frag"}));
  for (const bool cut : {false, true}) {
    for (const bool shadowed : {false, true}) {
      std::vector<gl::Define> defines = {{"PLANE", "1"},
                                         {shadowed ? "SHADOWED_PLANE" : "UNSHADOWED_PLANE", "1"}};
      if (cut) defines.push_back({"CUT_PLANE", "1"});
      ASPIC_TRY((cut ? p.cut_plane : p.plane)[shadowed],
                drawing({"render/terrain.vert", "render/terrain.frag"}, defines));
    }
  }
  for (int light = 0; light < LIGHTS; ++light) {
    const gl::Define shaded[] = {
        {"PLANE", "1"}, {"SHADOWED_PLANE", "1"}, {"SHADED_LIGHT", std::to_string(light)}};
    ASPIC_TRY(p.shade[static_cast<std::size_t>(light)],
              drawing({"render/terrain.vert", "render/shade.frag"}, shaded));
  }
  ASPIC_TRY(p.solid, drawing({"render/terrain.vert", "render/terrain.frag"}));
  ASPIC_TRY(p.glass, drawing({"render/terrain.vert", "render/glass.frag"}));
  ASPIC_TRY(p.sky, drawing({"render/screen.vert", "render/sky.frag"}));
  const std::array several = {gl::Define{"SEVERAL_SAMPLES", "1"}};
  ASPIC_TRY(p.halve[0], drawing({"render/screen.vert", "render/halve.frag"}));
  ASPIC_TRY(p.halve[1], drawing({"render/screen.vert", "render/halve.frag"}, several));
  ASPIC_TRY(p.ghost, drawing({"render/screen.vert", "render/ghost.frag"}));
  ASPIC_TRY(p.present, drawing({"render/screen.vert", "render/present.frag"}));
  return p;
}

}  // namespace aspic
