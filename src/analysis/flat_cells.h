#pragma once
// Cells of bodies that are flat or inside out: springs hold such a shape for ever, as they hold the right
// one.
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace aspic {

/// How many cells of a body are.
struct FlatCells {
  std::uint32_t body = 0;  ///< index in Model::bodies
  std::uint64_t cells = 0;
};

class FlatCellSearch {
 public:
  explicit FlatCellSearch(const Model& model);
  /// Bodies with such cells at a state, ascending. A cell is flat below a hundredth of its volume at rest.
  std::vector<FlatCells> find(const State& state) const;

 private:
  struct Cells {
    std::uint32_t body, first_particle;
    Lattice lattice;
    std::vector<std::uint32_t> particle;  // by point, relative to the first; empty: as points are counted
    double least;                         // volume of a cell that is not flat [m³]; < 0 of mirrored lattices
  };
  static double volume(const Cells& of, const std::vector<Vec3>& x, const Lattice::Place& cell);
  std::vector<Cells> bodies_;
};

}  // namespace aspic
