#pragma once
// What a renderer is made of: for its own sources alone.
#include <glad/gl.h>

#include <algorithm>

#include "render/backdrop.h"
#include "render/body_painter.h"
#include "render/light_maps.h"
#include "render/model_buffers.h"
#include "render/moving_part.h"
#include "render/picture_passes.h"
#include "render/programs.h"
#include "render/reference_ground.h"
#include "render/renderer.h"
#include "render/targets.h"
#include "render/terrain_painter.h"

namespace aspic {

struct Renderer::Parts {
  gl::Context* context = nullptr;
  RenderPrograms programs;
  std::optional<OverlayPainter> overlay;
  TerrainPainter terrain;
  ReferenceGround reference_ground;
  LightMaps lights;
  gl::Texture colour_map;
  ScaleMap uploaded_map = ScaleMap::automatic;  // that of colour_map; automatic: none yet
  QuantityRange range = {0.0, 1.0};
  gl::Buffer frame;
  gl::VertexArray nothing;
  int samples = 4;
  std::optional<PictureTargets> targets;
  const Model* model = nullptr;
  std::optional<ModelBuffers> buffers;
  gl::Buffer uploaded, uploaded_balls;
  std::vector<layout::Particle> uploaded_particles;  // the same again, unless there are too many
  std::vector<layout::Ball> uploaded_ball_items;
  std::uint64_t uploads = 0;     // of states that differ from the one before
  bool upload_is_whole = false;  // what the device has is all of the last one
  Extent rods;
  Backdrop backdrop;
  gl::ShaderLibrary shaders;
  // Of the picture last drawn, for what is asked about it afterwards.
  std::optional<DeviceState> drawn_state;
  render_layout::Frame drawn_frame = {};
  ViewSettings drawn_view;
  std::unique_ptr<Picker> picker;
  std::unique_ptr<HighlightPainter> highlight;
  std::unique_ptr<SectionPainter> section;
  std::unique_ptr<ArrowPainter> arrows;
  std::uint64_t picks = 0;
  std::unique_ptr<gl::PassProfiler> profiler;

  Status prepare_targets(int width, int height, int wanted_samples);
  Status prepare_highlight();
  Status prepare_section();
  Status draw_arrows(const ViewSettings& view, const ArrowSet& set);
  /// This pass is over.
  void mark(PicturePass pass) const {
    if (profiler) profiler->mark(static_cast<std::size_t>(pass));
  }
  void bind_frame(const render_layout::Frame& block);
  bool prepare_backdrop(const std::vector<Terrain>& placed, const Camera& camera,
                        const PictureOptions& options);
  void draw_ground(const std::vector<Terrain>& placed, const Camera& camera, const PictureOptions& options,
                   bool shadows) const;
  bool knows(const DeviceState& state) const;
  std::vector<gl::PixelBox> around_flesh(const DeviceState& state) const;
  std::vector<gl::PixelBox> changing(const DeviceState& state, const Camera& camera,
                                     const std::vector<Terrain>& placed, const PictureOptions& options) const;
  void prepare_light(const DeviceState& state, const PictureOptions& options);
  void prepare_scale(const DeviceState& state, const PictureOptions& options);
  QuantityRange measured_range(const ViewSettings& view) const;
  /// Of this picture.
  BodyPainter bodies(const DeviceState& state, const ViewSettings& view) const {
    return {*model,     programs, *buffers, *targets,
            colour_map, state,    view,     view.cut.on() ? section.get() : nullptr};
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

}  // namespace aspic
