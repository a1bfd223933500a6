#pragma once
// The text on an image.
#include <vector>

#include "aspic/scene.h"
#include "render/overlay.h"

namespace aspic {

/// The parameters of a run, one line each: author, terrain, contact, integrator, h, k and c of the first body
/// by spring type, offset and rotation of a cube, number and contact of balls, time. `time` in seconds. Lines
/// that the scene has nothing for are left out, and spring types that are alike share one.
std::vector<OverlayLine> overlay_lines(const Scene& scene, double time);

/// The line of the author; none for a scene without one.
std::vector<OverlayLine> author_lines(const Scene& scene);

/// A number in few characters for people: at most four significant digits, no exponent between 0.001 and 10⁶.
std::string short_number(double value);

}  // namespace aspic
