#include "render/programs.h"

#include <algorithm>

#include "model/terrain.h"
#include "render/color_map.h"
#include "render/light_maps.h"
#include "render/section.h"

namespace aspic {

void RenderProgram::start() const {
  if (program_ || ready_) return;
  // An error comes up again in get().
  if (auto started = source_->context.programs().start(source_->library, stages_, defines_))
    program_ = std::move(*started);
}

const gl::Program& RenderProgram::get() const {
  static const gl::Program nothing;
  if (!ready_) {
    gl::ProgramCache& programs = source_->context.programs();
    auto made = program_ ? Result(program_) : programs.start(source_->library, stages_, defines_);
    const Status finished = made ? programs.finish(*made) : Status(made.error());
    ready_ = finished.ok();
    program_ = ready_ ? *made : nullptr;
    if (!ready_ && source_->refused) source_->refused = finished;
  }
  return program_ ? *program_ : nothing;
}

RenderPrograms RenderPrograms::create(gl::Context& context, const gl::ShaderLibrary& library) {
  RenderPrograms p;
  p.source = std::make_shared<RenderProgram::Source>(RenderProgram::Source{context, library});
  const auto kernel = [&](std::string_view path) { return RenderProgram(p.source, {.compute = path}); };
  const auto drawing = [&](const gl::ProgramStages& stages, std::vector<gl::Define> defines = {}) {
    return RenderProgram(p.source, stages, std::move(defines));
  };
  p.bounds = kernel("render/bounds.comp");
  p.balls_turn = kernel("render/balls.comp");
  p.light_boxes = kernel("render/light_boxes.comp");
  p.skin = kernel("render/skin.comp");
  p.mesh_skin = kernel("render/mesh_skin.comp");
  p.mesh_normals = kernel("render/mesh_normals.comp");
  p.quantity = kernel("render/quantity.comp");
  p.light_surface = drawing({"render/light_map.vert", "render/light_map.frag"});
  p.light_particles =
      drawing({"render/light_points.vert", "render/light_points.frag", "render/light_points.geom"});
  p.light_springs =
      drawing({"render/light_points.vert", "render/light_points.frag", "render/light_springs.geom"});
  p.light_balls =
      drawing({"render/light_balls.vert", "render/light_points.frag", "render/light_points.geom"});
  p.thickness = drawing({"render/thickness.vert", "render/thickness.frag"});
  p.jelly_far = drawing({"render/jelly.vert", "render/jelly_far.frag"});
  p.jelly = drawing({"render/jelly.vert", "render/jelly.frag"});
  p.particles = drawing({"render/particles.vert", "render/particles.frag", "render/particles.geom"});
  p.springs = drawing({"render/springs.vert", "render/springs.frag", "render/springs.geom"});
  p.balls = drawing({"render/balls.vert", "render/balls.frag", "render/balls.geom"});
  p.rods = drawing({"render/rods.vert", "render/rods.frag"});
  p.sheet = drawing({"render/jelly.vert", "render/sheet.frag"});
  const gl::Define plane = {"PLANE", "1"};
  for (const bool cut : {false, true}) {
    for (const bool shadowed : {false, true}) {
      std::vector<gl::Define> defines = {plane, {shadowed ? "SHADOWED_PLANE" : "UNSHADOWED_PLANE", "1"}};
      if (cut) defines.push_back({"CUT_PLANE", "1"});
      (cut ? p.cut_plane : p.plane)[shadowed] =
          drawing({"render/terrain.vert", "render/terrain.frag"}, std::move(defines));
    }
  }
  for (std::size_t light = 0; light < LIGHTS; ++light)
    p.shade[light] = drawing({"render/terrain.vert", "render/shade.frag"},
                             {plane, {"SHADOWED_PLANE", "1"}, {"SHADED_LIGHT", std::to_string(light)}});
  p.solid = drawing({"render/terrain.vert", "render/terrain.frag"});
  p.glass = drawing({"render/terrain.vert", "render/glass.frag"});
  p.reference_ground = drawing({"render/terrain.vert", "render/reference_ground.frag"}, {plane});
  p.sky = drawing({"render/screen.vert", "render/sky.frag"});
  p.halve[0] = drawing({"render/screen.vert", "render/halve.frag"});
  p.halve[1] = drawing({"render/screen.vert", "render/halve.frag"}, {{"SEVERAL_SAMPLES", "1"}});
  p.overlay = drawing({"render/overlay.vert", "render/overlay.frag"});
  p.ghost = drawing({"render/screen.vert", "render/ghost.frag"});
  p.present = drawing({"render/screen.vert", "render/present.frag"});
  return p;
}

void RenderPrograms::start(const Model& model, const ViewSettings& view, bool shadows) const {
  const auto begin = [](bool needed, const auto&... programs) {
    if (needed) (programs.start(), ...);
  };
  const auto has = [&](SurfaceStyle style) {
    return view.draw.solid &&
           std::ranges::any_of(model.bodies, [=](const Body& b) { return b.style == style; });
  };
  const bool has_balls = model.ball_count() > 0, flesh = has(SurfaceStyle::flesh);
  const bool lines = draws_springs(drawn_springs(view));
  begin(true, light_boxes, sky, bounds);
  begin(view.draw.solid, skin);
  begin(view.draw.solid && std::ranges::any_of(model.bodies, [](const Body& b) { return !b.rods.empty(); }),
        rods);
  begin(std::ranges::any_of(model.bodies, [](const Body& b) { return !b.skin.empty(); }), mesh_skin,
        mesh_normals);
  begin(has_scale(view.color), quantity);
  begin(has_balls, balls_turn);
  begin(has_balls && draws_balls(view.draw), balls);
  begin(flesh, thickness, jelly_far, jelly, halve[1]);
  begin(has(SurfaceStyle::sheet), sheet);
  begin(lines || has(SurfaceStyle::cords), springs);
  begin(view.draw.particles, particles);
  begin(shadows && view.draw.solid, light_surface);
  begin(shadows && has_balls && draws_balls(view.draw), light_balls);
  begin(shadows && view.draw.particles, light_particles);
  begin(shadows && draws_springs(view.draw), light_springs);
  for (const Terrain& terrain : model.terrain) {
    const TerrainShapeRow& row = terrain_row(terrain.shape);
    const auto& flat = row.surface ? cut_plane : plane;
    begin(view.terrain && row.flat, flat[0]);
    begin(view.terrain && row.flat && shadows, flat[1], shade[0], shade[1]);
    begin(view.terrain && row.surface, row.glass ? glass : solid);
  }
  begin(view.ground.has_value(), reference_ground);
  begin(true, overlay);
}

}  // namespace aspic
