#pragma once
// Changes of a body's layers of cells, as people make them.
#include <array>
#include <cstddef>

#include "aspic/settings.h"

namespace aspic::app {

/// An empty cell as the window writes it.
inline constexpr char empty_cell = '.';

/// A cell of a layer: its row from back to front, its column from left to right.
struct CellPlace {
  int row = 0, column = 0;
  friend bool operator==(const CellPlace&, const CellPlace&) = default;
};

/// Where layers grow and shrink.
enum class CellSide { left, right, back, front, bottom, top };

/// Cells along x, y and z; zeros where there are none.
std::array<int, 3> size_of(const CellLayers& layers);
/// Legal for a cell of the layers.
char cell_at(const CellLayers& layers, int layer, const CellPlace& place);
/// Whether there is such a cell.
bool is_inside(const CellLayers& layers, const CellPlace& place);

/// Every cell on the way from one place to another gets the character, the same cells in both directions;
/// places outside are passed over.
void paint(CellLayers& layers, int layer, const CellPlace& one, const CellPlace& other, char cell);
/// Every cell of a layer gets the character.
void fill(CellLayers& layers, int layer, char cell);

/// One more column, row or layer of empty cells; the others stay where they are in the world.
void grow(VoxelsSettings& voxels, CellSide side);
/// One less. False, and nothing changes, where it is the last.
bool shrink(VoxelsSettings& voxels, CellSide side);
/// The layer above, a new one over the topmost, becomes like this one.
void copy_up(VoxelsSettings& voxels, int layer);

}  // namespace aspic::app
