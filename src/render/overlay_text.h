#pragma once
// The text on a picture.
#include <vector>

#include "model/settings.h"
#include "render/overlay.h"

namespace aspic {

/// Terrain, integrator, h, k and c by spring type, offset and rotation of the first cube, time: one line
/// each. `time` in seconds. Lines that the scene has nothing for are left out.
std::vector<OverlayLine> overlay_lines(const ModelSettings& settings, double time);

/// A number in few characters for people: at most four significant digits, no exponent between 0.001 and 10⁶.
std::string short_number(double value);

}  // namespace aspic
