#pragma once
// Shapes and texture of the terrain, made here by procedures.

#include <cstddef>
#include <vector>

#include "model/model.h"
#include "render/mesh.h"

namespace aspic {

/// The square −1…1 in x and y, z = 0; without normals.
Mesh square_mesh();

/// The unit sphere by latitude (`rings` ≥ 2 strips) and longitude (`sectors` ≥ 3), poles at ±y.
Mesh sphere_mesh(int rings, int sectors);

/// The surface of a terrain whose shape has one (TerrainShapeRow::surface), by as many strips of v and of u.
/// Outside is the free side; of glass the other.
Mesh terrain_mesh(const Terrain& terrain, int rings, int sectors);

/// A floor of square tiles, 4 × 4 of them, as size² texels RGBA with 8 bits each, sRGB encoded; the edges
/// match when it is repeated. Each tile has its own shade of warm gray, a grain of five octaves of value
/// noise and a beveled joint. `size` is a power of two ≥ 64.
std::vector<std::byte> ground_texels(int size);

}  // namespace aspic
