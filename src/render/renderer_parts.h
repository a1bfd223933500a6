#pragma once
// What a renderer is made of: for its own sources alone.
#include <glad/gl.h>

#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/backdrop.h"
#include "render/body_painter.h"
#include "render/frame_passes.h"
#include "render/frame_policy.h"
#include "render/light_maps.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "render/reference_ground.h"
#include "render/renderer.h"
#include "render/targets.h"
#include "render/terrain_painter.h"

namespace aspic {

/// An image that is being drawn.
struct Drawing {
  DeviceState state;
  ImageOptions options;
  Camera camera;
  std::vector<Terrain> terrain;     ///< where it is
  std::vector<gl::PixelBox> boxes;  ///< what is drawn, of an image that began with the backdrop
  Status written;                   ///< of what may fail on the way
  std::size_t step = 0;             ///< that comes next, of Renderer::Parts::steps()
  bool kept = false;                ///< it began with the backdrop
};

struct Renderer::Parts {
  /// One part of drawing an image.
  struct Step {
    std::optional<FramePass> pass;  ///< that it is counted to; absent: it tells of several itself
    void (*draw)(Parts& parts, Drawing& drawing);
  };
  /// In their order; frame_steps.cpp.
  static std::span<const Step> steps();

  Parts();
  ~Parts();

  gl::Context* context = nullptr;
  RenderPrograms programs;
  std::optional<OverlayPainter> overlay;
  TerrainPainter terrain;
  ReferenceGround reference_ground;
  LightMaps lights;
  gl::Texture color_map;
  ScaleMap uploaded_map = ScaleMap::automatic;  // that of color_map; automatic: none yet
  QuantityRange range = {0.0, 1.0};
  gl::Buffer frame;
  gl::VertexArray nothing;
  int samples = 4;
  std::optional<ImageTargets> targets;  // of the image that is drawn, or was last
  std::optional<ImageTargets> earlier;  // of the one before, while another is drawn in parts
  std::optional<Drawing> drawing;
  const Model* model = nullptr;
  std::optional<ModelBuffers> buffers;
  gl::Buffer uploaded, uploaded_balls;
  std::vector<layout::Particle> uploaded_particles;  // the same again, unless there are too many
  std::vector<layout::Ball> uploaded_ball_items;
  std::uint64_t uploads = 0;            // of states that differ from the one before
  bool upload_is_whole = false;         // what the device has is all of the last one
  std::unique_ptr<FramePolicy> policy;  // null: hardware
  class Surroundings;
  std::unique_ptr<Surroundings> surroundings;  // where there is a policy
  // Of the image last drawn, for what is asked about it afterwards.
  std::optional<DeviceState> drawn_state;
  render_layout::Frame drawn_frame = {};
  ViewSettings drawn_view;
  std::unique_ptr<Picker> picker;
  std::unique_ptr<HighlightPainter> highlight;
  std::unique_ptr<SectionPainter> section;
  std::unique_ptr<ArrowPainter> arrows;
  std::uint64_t picks = 0;
  std::unique_ptr<gl::PassProfiler> profiler;

  Status start(int width, int height, const DeviceState& state, const ImageOptions& options);
  Status finish();
  void abandon();
  void ready_to_draw() const;
  void resume();
  void leave() const;
  /// The images of the image last drawn. Legal once there is one.
  const ImageTargets& last() const {
    assert(earlier || targets);
    return earlier ? *earlier : *targets;
  }
  Status prepare_targets(int width, int height, int wanted_samples);
  Status prepare_highlight();
  Status prepare_section();
  Status draw_arrows(const ViewSettings& view, const ArrowSet& set);
  /// This pass is over.
  void mark(FramePass pass) const {
    if (profiler) profiler->mark(static_cast<std::size_t>(pass));
  }
  void bind_frame(const render_layout::Frame& block);
  void draw_ground(const Drawing& drawing, bool shadows) const;
  /// Whether what is in the state is known here: where other states are, only the device knows.
  bool knows(const DeviceState& state) const;
  void prepare_surroundings(Drawing& drawing);
  void prepare_light(const DeviceState& state, const ImageOptions& options);
  void prepare_scale(const DeviceState& state, const ImageOptions& options);
  QuantityRange measured_range(const ViewSettings& view) const;
  BodyPainter bodies(const Drawing& d) const {
    const ViewSettings& view = d.options.view;
    return {*model,        programs, *buffers, *targets,
            color_map,     d.state,  view,     view.cut.on() ? section.get() : nullptr,
            d.options.tint};
  }
  bool draws_flesh(const Drawing& d) const { return d.options.view.draw.solid && has(SurfaceStyle::flesh); }
  /// The complete image by one program.
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
