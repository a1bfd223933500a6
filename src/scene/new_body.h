#pragma once
// One more body for a scene, where it is in nobody's way.
#include <cstddef>

#include "aspic/scene.h"
#include "model/bodies.h"

namespace aspic {

/// Adds an element to a list of bodies, like the last of its kind or with default values, at a place of
/// place_body().
void add_body(Scene& scene, const SettingsList& list);

/// The same of a box, half as high and deep as a cube that add_body() adds is wide.
void add_box(Scene& scene);

/// Moves an element of a list of bodies to where it is in nobody's way when the scene starts. What has a
/// surface goes straight up, to fall on the highest that is under it from a tenth of its size above; it stays
/// where that is lower, or nothing is there. Nets, balls and launchers, where they would overlap others, go
/// next to them, towards +x; a launcher throws at the bodies that there are. All are lifted out of terrain
/// that they would reach into.
void place_body(Scene& scene, const SettingsList& list, std::size_t index);

/// The longest edge of the box around all particles and balls at the start [m]; 0: there are none.
double longest_extent(const ModelSettings& settings);

}  // namespace aspic
