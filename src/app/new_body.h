#pragma once
// One more body for a scene, where it is in nobody's way.
#include "app/scene_control.h"
#include "model/bodies.h"

namespace aspic::app {

/// Adds an element to a list of bodies, like the last of its kind or with default values, as one change for
/// undo. Where it would overlap other bodies it is placed next to them, towards +x, and above the terrain
/// that it would reach into; a launcher throws at the bodies that there are.
void add_body(SceneControl& scene, const SettingsList& list);

}  // namespace aspic::app
