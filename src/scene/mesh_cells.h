#pragma once
// Meshes as bodies of cells.
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "mesh/read_mesh.h"
#include "mesh/voxelize.h"

namespace aspic {

/// Cells along the longest edge where nobody says how many.
inline constexpr int usual_mesh_cells = 24;

/// The axes of a file that may point upwards, as scenes and options name them.
inline constexpr Named<UpAxis> up_axes[] = {{UpAxis::y, "y"}, {UpAxis::z, "z"}};

/// Puts a mesh in the place of a body's layers, size and skin; its cells are of the body's material, or of
/// the one that its palette has. Returns what was repaired and what came of it, a sentence each without a
/// full stop. Errors: as voxelize(); a palette of several materials.
Result<std::vector<std::string>> take_mesh(VoxelsSettings& voxels, const MeshFile& file,
                                           const VoxelizationSettings& how, const std::string& name);

}  // namespace aspic
