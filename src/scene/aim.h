#pragma once
// The camera of a scene that gives none.
#include "aspic/scene.h"

namespace aspic {

/// Points the camera at the box around bodies and balls where they start, or around launchers where there is
/// nothing else: the box fills at most half of the image's height, and less where the terrain that it falls
/// on is near enough to be shown as well. Leaves a scene without any of them as it is.
void aim_at_bodies(Scene& scene);

}  // namespace aspic
