#pragma once
// One more body for a scene, where it is in nobody's way.
#include "aspic/scene.h"
#include "model/bodies.h"

namespace aspic {

/// Adds an element to a list of bodies, like the last of its kind or with default values. Where it would
/// overlap other bodies it is placed next to them, towards +x, and above the terrain that it would reach
/// into; a launcher throws at the bodies that there are.
void add_body(Scene& scene, const SettingsList& list);

}  // namespace aspic
