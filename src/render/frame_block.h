#pragma once
// The block that every drawing shader reads, of one image.
#include "aspic/scene.h"
#include "model/model.h"
#include "render/camera.h"
#include "render/layout.h"
#include "render/quantity.h"

namespace aspic {

/// What the block holds besides model and camera.
struct FrameContent {
  ViewSettings view;
  QuantityRange range = {};  ///< ends of the color scale
  bool has_flesh = false;    ///< the model has translucent bodies
  bool shadows = true;
  std::uint64_t step = 0;      ///< of the state: moving terrain is where it is then
  double section_depth = 0.0;  ///< behind the cut [m]
};

/// The block of an image of width × height pixels.
render_layout::Frame frame_block(const Model& model, const Camera& camera, int width, int height,
                                 const FrameContent& content);

/// A range as the block holds it: its lower end, and one over its width (0 of an empty one).
glm::vec4 quantity_scale(const QuantityRange& range);

/// The same for the `side` × `side` pixels around the middle of pixel (x, y) [pixels from left and top] of a
/// view of width × height pixels, alone: what lies elsewhere is clipped.
render_layout::Frame frame_around(const render_layout::Frame& whole, double x, double y, double width,
                                  double height, int side);

}  // namespace aspic
