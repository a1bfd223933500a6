#pragma once
// The skin of a model's bodies: which particles it joins, and what normals are summed from.
#include <array>
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace aspic {

/// Triangles over global particle indices. They turn counterclockwise seen from outside the undeformed
/// body, or from the side that an open surface turns to. Groups of normals that meet have separate
/// vertices there, so that an edge can be sharp.
struct Surface {
  struct Part {
    std::uint32_t first_index = 0, index_count = 0;  ///< of one body, into `indices`
    bool mesh = false;  ///< of a mesh: `indices` are the nearest particles, about where its vertices are
  };

  std::vector<std::uint32_t> indices;  ///< three per triangle: particles
  std::vector<std::uint32_t> corners;  ///< the same triangles: vertices
  std::vector<Part> parts;             ///< by body, in the order of Model::bodies
  std::vector<Part> coarse_parts;  ///< the same skins with fewer triangles, over some of the same vertices

  /// The fans: vertex i of the skin is particle fan_vertex[i]; at it meet the quads
  /// fan_start[i] … fan_start[i + 1] − 1, those of its own group before fan_own[i], of each of which `fan`
  /// holds the vertex's next and previous neighbor (two words: particles).
  std::vector<std::uint32_t> fan_vertex, fan_start, fan_own, fan;

  /// The vertices of meshes, which come after those of fans: the particles at the corners of the cell of
  /// each, its place in the cell, and its triangles mesh_start[i] … mesh_start[i + 1] − 1, of each of which
  /// `mesh_fan` holds the next and the previous vertex.
  std::vector<std::array<std::uint32_t, 8>> mesh_corners;
  std::vector<std::array<float, 4>> mesh_places;
  std::vector<std::uint32_t> mesh_start, mesh_fan;
};

/// The surfaces of all bodies. A body without a surface has no triangles.
Surface make_surface(const Model& model);

}  // namespace aspic
