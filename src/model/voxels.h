#pragma once
// Bodies of cells: from the layers of a scene to a lattice, the materials of its cells, and what springs and
// particles get from them (docs/physics.md, section 2).
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aspic/settings.h"
#include "base/result.h"
#include "model/counts.h"
#include "model/lattice.h"

namespace aspic {

/// Most points of a body's lattice, and most cells along an axis.
inline constexpr std::uint64_t most_lattice_points = 512ull * 512 * 512;
inline constexpr int most_cells_along = 4095;

/// Whether a character of a layer is an empty cell, and whether it may be a full one.
bool is_empty_cell(char c);
bool is_full_cell(char c);

/// What is wrong with a body of cells.
struct CellFault {
  std::string key;                          ///< of [[voxels]]
  std::string message;                      ///< without the key
  std::optional<std::size_t> element = {};  ///< of the key's list
};

/// The full cells of a body and the box around them.
struct VoxelShape {
  Lattice lattice;                 ///< of the box; its full_cells are empty where all are full
  std::vector<char> cells;         ///< of the box, in the order of the lattice's cells
  std::array<int, 3> offset = {};  ///< first cell of the box among the layers'
  std::array<int, 3> grid = {};    ///< cells of the layers along x, y and z
  std::size_t full = 0;            ///< full cells
  std::size_t pieces = 1;          ///< before any was left out
};

/// What the layers make, after Pieces::largest has left out all others.
std::variant<VoxelShape, CellFault> shape_of(const VoxelsSettings& voxels);

/// What is wrong with the body: its cells, its palette, or a material that the scene does not have.
std::optional<CellFault> fault_of(const ModelSettings& settings, const VoxelsSettings& voxels);

/// Of a body without fault: the material of each character, by code; the same material has one number, in the
/// order of `materials`.
struct CellMaterials {
  std::vector<MaterialSettings> materials;    ///< that cells have, in the order of the scene's
  std::array<std::uint8_t, 128> number = {};  ///< of each full cell's character
};
CellMaterials materials_of(const ModelSettings& settings, const VoxelsSettings& voxels,
                           const VoxelShape& shape);

/// Edges along which two cells hang together that share nothing more: hinges.
std::size_t hinges(const Lattice& lattice);

/// Numbers of a body with a fault are 0.
ModelCounts voxel_counts(const VoxelsSettings& voxels);

/// Appends the body to the model. Errors (scene_rejected): a fault; an unknown face or corner, or an index
/// that is no particle, in `pinned`.
Status add_voxels(Model& model, const ModelSettings& settings, const VoxelsSettings& voxels);

}  // namespace aspic
