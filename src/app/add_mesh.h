#pragma once
// Mesh files as bodies of the scene that is open.
#include <string>

#include "app/messages.h"
#include "app/scene_control.h"

namespace aspic::app {

/// Adds the cells inside a mesh file to the scene, as one change for undo, and says what was repaired and
/// made. The time step becomes one that the body is stable with, where it was stable without. On an error
/// nothing changes and a message says why.
void add_mesh(SceneControl& scene, Messages& messages, const std::string& path);

}  // namespace aspic::app
