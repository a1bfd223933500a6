#include "model/voxel_springs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "model/material.h"

namespace aspic {
namespace {

std::size_t cell_index(const Lattice& lattice, const Lattice::Place& cell) {
  const std::array<int, 3> count = lattice.cells();
  return (static_cast<std::size_t>(cell[0]) * static_cast<std::size_t>(count[1]) +
          static_cast<std::size_t>(cell[1])) *
             static_cast<std::size_t>(count[2]) +
         static_cast<std::size_t>(cell[2]);
}

/// Calls take(cell index) for each full cell around a point.
template <class Take>
void for_each_cell_at(const Lattice& lattice, const Lattice::Place& point, const Take& take) {
  for (const int i : {-1, 0})
    for (const int j : {-1, 0})
      for (const int k : {-1, 0}) {
        const Lattice::Place cell = {point[0] + i, point[1] + j, point[2] + k};
        if (lattice.full(cell)) take(cell_index(lattice, cell));
      }
}

}  // namespace

VoxelSprings::VoxelSprings(const VoxelShape& shape, const CellMaterials& materials, double size)
    : shape_(shape), size_(size) {
  for (const char c : shape.cells) material_.push_back(materials.number[static_cast<std::size_t>(c)]);
  // The mean density around each particle, and the particles.
  std::vector<double> density;
  for (std::size_t point = 0; point < shape.lattice.points(); ++point) {
    double sum = 0.0;
    int cells = 0;
    for_each_cell_at(shape.lattice, shape.lattice.place(point), [&](std::size_t cell) {
      sum += materials.materials[material_[cell]].density;
      ++cells;
    });
    if (cells > 0) density.push_back(sum / cells);
  }
  const auto particles = static_cast<double>(density.size());
  const std::array<int, 3> n = shape.lattice.cells();
  // As of a cube: its volume is the product of its edges.
  const auto mass_of = [&](double rho) {
    return shape.lattice.all_full()
               ? rho * (size * n[0]) * (size * n[1]) * (size * n[2]) / particles
               : rho * (size * size * size) * static_cast<double>(shape.full) / particles;
  };
  for (const MaterialSettings& material : materials.materials)
    springs_.push_back(lattice_springs(material, size, mass_of(material.density)));
  if (uniform()) {
    masses_.assign(density.size(), mass_of(materials.materials.front().density));
    return;
  }
  double total = 0.0;
  for (std::size_t c = 0; c < shape.cells.size(); ++c)
    if (shape.cells[c] != '.') total += materials.materials[material_[c]].density;
  const double sum = std::accumulate(density.begin(), density.end(), 0.0);
  for (const double rho : density) masses_.push_back(total * (size * size * size) * (rho / sum));
}

SpringClass VoxelSprings::class_of(std::uint32_t length, const Shares& shares) const {
  SpringClass made = {lattice_class_types[length], 0.0, 0.0, size_ * std::sqrt(length + 1.0), false};
  int cells = 0;
  for (std::size_t m = 0; m < shares.size(); ++m) {
    cells += shares[m];
    made.stiffness += shares[m] * springs_[m].stiffness;
    made.damping += shares[m] * springs_[m].damping;
  }
  made.stiffness /= cells;
  made.damping /= cells;
  return made;
}

void VoxelSprings::append_classes(std::vector<SpringClass>& classes) const {
  for (std::uint32_t length = 0; length < lattice_class_types.size(); ++length)
    classes.push_back(class_of(length, {1}));
}

void VoxelSprings::append_springs(std::vector<Spring>& springs, std::vector<SpringClass>& classes,
                                  std::uint32_t first_particle) const {
  const Lattice& lattice = shape_.lattice;
  const std::vector<std::uint32_t> numbers = particle_numbers(lattice);
  const auto first_class = static_cast<std::uint32_t>(classes.size());
  std::vector<std::map<Shares, std::uint32_t>> numbered(lattice_class_types.size());
  const auto number_of = [&](std::uint32_t length, const Shares& shares) {
    const auto [at, fresh] =
        numbered[length].try_emplace(shares, static_cast<std::uint32_t>(classes.size()) - first_class);
    if (fresh) classes.push_back(class_of(length, shares));
    return first_class + at->second;
  };
  for (std::size_t m = 0; m < springs_.size(); ++m) {
    Shares alone(springs_.size(), 0);
    alone[m] = 1;
    for (std::uint32_t length = 0; length < lattice_class_types.size(); ++length) number_of(length, alone);
  }
  Shares shares(springs_.size());
  for (std::size_t point = 0; point < numbers.size(); ++point) {
    const auto [i, j, k] = lattice.place(point);
    for (const LatticeDirection& o : upper_directions()) {
      const SpringCells cells = cells_along(lattice, {i, j, k}, o);
      if (cells.count == 0) continue;
      std::ranges::fill(shares, 0);
      int common = 0;
      for (std::size_t c = 0; c < cells.count; ++c) ++shares[material_[cell_index(lattice, cells.at[c])]];
      for (const int share : shares) common = std::gcd(common, share);
      for (int& share : shares) share /= common;
      const std::uint32_t other = lattice.index({i + o.di, j + o.dj, k + o.dk});
      springs.push_back({first_particle + numbers[point], first_particle + numbers[other],
                         number_of(o.spring_class, shares)});
    }
  }
}

}  // namespace aspic
