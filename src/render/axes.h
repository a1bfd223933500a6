#pragma once
// The world's axes as a camera sees their directions, for a corner of the image.
#include <array>

#include "render/camera.h"
#include "render/color_map.h"

namespace aspic {

/// One of the axes: from the middle of the corner's drawing to (right, down), in lengths of an axis that lies
/// square to the view.
struct AxisArm {
  char letter = 'x';
  double right = 0.0, down = 0.0;
  double away = 0.0;  ///< how far it points away from the eye, −1…1
  Color color = {};
};

/// Those that point away first, so that later ones are drawn over them.
std::array<AxisArm, 3> axes_seen(const Camera& camera);

/// Sizes of the drawing, in heights of its text.
inline constexpr double axis_length = 2.2, axis_letter_at = 1.28, axes_reach = 3.4, axis_width = 0.16;

}  // namespace aspic
