#pragma once
// Springs and masses of bodies of cells. Cells share a spring and a particle equally: a spring of n cells has
// the mean of the stiffness and damping that it would have in a body of each cell's material, which is their
// sum with kᵢ/n each; so a body of one material is that of a cube.
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "model/model.h"
#include "model/voxels.h"

namespace aspic {

class VoxelSprings {
 public:
  /// `size`: edge of a cell [m].
  VoxelSprings(const VoxelShape& shape, const CellMaterials& materials, double size);

  /// Whether all cells are of one material.
  bool uniform() const { return springs_.size() == 1; }
  /// By particle [kg]: shares of the body's mass, by the mean density of the cells around it.
  const std::vector<double>& masses() const { return masses_; }
  /// The four classes of a uniform body.
  void append_classes(std::vector<SpringClass>& classes) const;
  /// The springs, sorted by (a, b), with classes by type and shares of materials: those of one material alone
  /// in the order of lattice_class_types, then mixtures as springs meet them.
  void append_springs(std::vector<Spring>& springs, std::vector<SpringClass>& classes,
                      std::uint32_t first_particle) const;

 private:
  /// How many of a spring's cells are of each material, in lowest terms.
  using Shares = std::vector<int>;

  SpringClass class_of(std::uint32_t length, const Shares& shares) const;

  const VoxelShape& shape_;
  double size_;
  std::vector<std::uint8_t> material_;   // by cell
  std::vector<SpringSettings> springs_;  // by material
  std::vector<double> masses_;
};

}  // namespace aspic
