#pragma once
// The rods that bodies hang on, drawn as tubes with round ends.

#include "model/model.h"
#include "render/mesh.h"

namespace aspic {

/// The rods of all bodies.
Mesh rod_mesh(const Model& model);

}  // namespace aspic
