#pragma once
// Which way faces turn.
#include "mesh/repair_mesh.h"

namespace aspic {

/// Turns faces to agree with their neighbors and each patch outwards, and writes into the repairs what it
/// turned, patches, cavities, open, crowded and twisted edges. Vertices are welded; no face has a corner
/// twice, and no two the same corners.
void orient_mesh(TriangleMesh& mesh, MeshRepairs& repairs);

}  // namespace aspic
