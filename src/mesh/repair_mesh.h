#pragma once
// What is wrong with meshes as they come, and what is done about it.
#include <cstddef>
#include <string>
#include <vector>

#include "model/triangle_mesh.h"

namespace aspic {

/// What was found and repaired. Faces are triangles.
struct MeshRepairs {
  std::size_t faces = 0;          ///< that are left
  std::size_t vertices = 0;       ///< that they use
  std::size_t welded = 0;         ///< vertices that were another one once more
  std::size_t not_finite = 0;     ///< faces left out: a corner is not finite, or farther than 1e12 from 0
  std::size_t zero_area = 0;      ///< faces left out
  std::size_t doubled = 0;        ///< faces left out: another one has the same corners
  std::size_t turned = 0;         ///< faces turned to agree with their neighbors, or outwards
  std::size_t patches = 0;        ///< parts connected over edges that have two faces
  std::size_t cavities = 0;       ///< closed parts inside another one and turned against it: hollows
  std::size_t open_edges = 0;     ///< edges of one face: rims of holes
  std::size_t crowded_edges = 0;  ///< edges of more than two faces
  std::size_t twisted_edges = 0;  ///< between faces that cannot be made to agree, as on a Möbius strip
  friend bool operator==(const MeshRepairs&, const MeshRepairs&) = default;
};

/// What was repaired, in sentences without a full stop; none where nothing was but welding.
std::vector<std::string> sentences_of(const MeshRepairs& repairs);

/// A mesh and what was done to it.
struct RepairedMesh {
  TriangleMesh mesh;
  MeshRepairs repairs;
};

/// Welds vertices that are equal to a millionth of the longest extent, leaves out faces without area or with
/// a corner that is not finite, and doubled ones; orients faces by their neighbors and each part outwards,
/// except a closed part inside another one that the file turns against it, which is a cavity. Of faces over
/// the same corners one is kept; where less than half of the mesh is doubled and the two are turned against
/// each other, none: they are a wall inside. Vertices that no face uses are left out. The mesh may come back
/// without any face.
RepairedMesh repair_mesh(const TriangleMesh& mesh);

}  // namespace aspic
