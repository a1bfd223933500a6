#pragma once
// Bodies, springs, particles and balls: everything of an image that a solver moves.
#include <optional>

#include "aspic/scene.h"
#include "device/device_state.h"
#include "model/model.h"
#include "render/color_map.h"
#include "render/model_buffers.h"
#include "render/programs.h"
#include "render/section.h"
#include "render/targets.h"

namespace aspic {

/// The walls of a translucent body that face away from the eye, or towards it.
enum class JellySide { far, near };

/// How deep light reaches into a body [m].
double light_reach(const Body& body);

/// Draws what one state of a model looks like, into the framebuffer that is bound. The frame block must be
/// bound, and the buffers prepared for state and view.
struct BodyPainter {
  const Model& model;
  const RenderPrograms& programs;
  const ModelBuffers& buffers;
  const ImageTargets& targets;
  const gl::Texture& color_map;
  const DeviceState& state;
  const ViewSettings& view;
  const SectionPainter* section = nullptr;  ///< prepared for the model where the view has a cut
  std::optional<Color> tint = {};           ///< of skins colored by material, instead of each body's own

  /// Into the target of that name, which it binds to its texture unit.
  void draw_thickness() const;
  void draw_rods_and_balls() const;
  /// Springs by type, at least a pixel wide; not the cords of nets.
  void draw_springs() const;
  /// Cords: where they are thinner than a pixel, they are a pixel wide and cover as much as their own width
  /// does. They blend in any order, so they come after everything opaque and hide nothing; where bodies are
  /// drawn later that may lie behind them, they are drawn again.
  void draw_cords() const;
  void draw_particles() const;
  /// What a cut shows of bodies' insides.
  void draw_section() const;
  void draw_sheets() const;
  void draw_jelly(JellySide side) const;

 private:
  void draw_run(const SpringRun& run) const;
  void draw_parts(const gl::Program& program, SurfaceStyle style) const;
  /// The skins of bodies of a style, each after prepare(body), from the array that is bound.
  template <class Prepare>
  void draw_skins(SurfaceStyle style, const Prepare& prepare) const;
};

}  // namespace aspic
