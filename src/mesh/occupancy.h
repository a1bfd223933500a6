#pragma once
// Cells of a body, full or empty, and how they hang together.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "aspic/settings.h"
#include "aspic/vec.h"
#include "base/result.h"
#include "model/lattice.h"

namespace aspic {

/// A grid of n × m × l cubic cells.
struct OccupancyGrid {
  std::array<int, 3> cells = {};   ///< n, m, l: along x, y, z, each ≥ 1
  double size = 0.0;               ///< edge of a cell [m]
  Vec3 origin;                     ///< the lowest corner of the first cell [m]
  std::vector<std::uint8_t> full;  ///< 1 or 0; cell (i, j, k) is at (i·m + j)·l + k

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(cells[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(cells[2]) +
           static_cast<std::size_t>(k);
  }
  std::array<int, 3> place(std::size_t index) const;
  bool contains(int i, int j, int k) const {
    return i >= 0 && i < cells[0] && j >= 0 && j < cells[1] && k >= 0 && k < cells[2];
  }
  bool is_full(int i, int j, int k) const { return contains(i, j, k) && full[index(i, j, k)] != 0; }
  Vec3 center(int i, int j, int k) const { return origin + size * Vec3{i + 0.5, j + 0.5, k + 0.5}; }
  std::size_t full_count() const;
  double volume() const { return static_cast<double>(full_count()) * size * size * size; }  ///< [m³]
};

/// The lattice of the grid's cells.
Lattice lattice_of(const OccupancyGrid& grid);

/// Sizes of the pieces in cells, largest first; of equal ones, that which comes first in the order of cells.
/// Empties all but the largest under Pieces::largest. Error (scene_rejected): several under Pieces::refuse.
Result<std::vector<std::size_t>> keep_pieces(OccupancyGrid& grid, Pieces pieces);

/// Edges and points of the lattice at which two full cells meet that no full cell next to them connects:
/// there the body bends as a hinge.
std::size_t count_hinges(const OccupancyGrid& grid);

}  // namespace aspic
