#pragma once
// Particles on the points of a cubic lattice: in which directions they have springs, and which particles and
// springs there are where cells are empty. Solvers, kernels and pages take it all from here.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "aspic/model.h"

namespace aspic {

/// A direction in which a particle of a lattice has a spring.
struct LatticeDirection {
  int di, dj, dk;              ///< steps to the other end along x, y and z
  std::uint32_t spring_class;  ///< relative to the body's first; its rest length is √(class + 1) spacings
  friend bool operator==(const LatticeDirection&, const LatticeDirection&) = default;
};

/// Types of a lattice's spring classes: along an edge of a cell, across a face, through a cell, over two
/// steps.
inline constexpr std::array lattice_class_types = {SpringType::structural, SpringType::shear,
                                                   SpringType::shear, SpringType::bending};

/// See lattice_directions().
inline constexpr auto lattice_direction_table = [] {
  std::array<LatticeDirection, 32> all = {};
  std::size_t n = 0;
  for (int di = -2; di <= 2; ++di) {
    for (int dj = -2; dj <= 2; ++dj) {
      for (int dk = -2; dk <= 2; ++dk) {
        const int squared = di * di + dj * dj + dk * dk;
        if (squared > 0 && squared <= 4) all[n++] = {di, dj, dk, static_cast<std::uint32_t>(squared - 1)};
      }
    }
  }
  return all;
}();
static_assert(lattice_direction_table.back() == LatticeDirection{2, 0, 0, 3}, "the table is full");

/// The directions of all springs of an inner particle in lexicographic order, which is ascending index of the
/// other end: 16 to lower ends, then the same to upper ones.
constexpr std::span<const LatticeDirection> lattice_directions() {
  return lattice_direction_table;
}
/// Those to upper ends.
constexpr std::span<const LatticeDirection> upper_directions() {
  return lattice_directions().subspan<lattice_direction_table.size() / 2>();
}

/// Points of a lattice n₀ × n₁ × n₂ and its cells, (n₀ − 1)(n₁ − 1)(n₂ − 1), each of which is full or empty.
/// A particle is at every corner of a full cell. A spring joins two corners of one full cell; over two steps,
/// it passes along an edge of two full cells that share a face. So a lattice whose cells are all full has a
/// particle at every point, and every spring whose ends are points.
struct Lattice {
  using Place = std::array<int, 3>;  ///< steps along x, y and z from the first point, or from the first cell

  std::array<int, 3> particles = {};  ///< n₀, n₁, n₂: points along x, y and z, each ≥ 2
  /// Which cells are full, in the order of points; none is listed where all are.
  std::vector<bool> full_cells = {};

  bool all_full() const { return full_cells.empty(); }
  std::size_t points() const {
    return static_cast<std::size_t>(particles[0]) * static_cast<std::size_t>(particles[1]) *
           static_cast<std::size_t>(particles[2]);
  }
  std::array<int, 3> cells() const { return {particles[0] - 1, particles[1] - 1, particles[2] - 1}; }
  /// Points from one to the next along x, y and z.
  std::array<int, 3> strides() const { return {particles[1] * particles[2], particles[2], 1}; }
  /// Points with the same i are a plane, those with the same i and j a row.
  std::size_t plane_count() const { return static_cast<std::size_t>(particles[0]); }
  std::size_t row_count() const { return static_cast<std::size_t>(particles[1]); }
  std::size_t row_size() const { return static_cast<std::size_t>(particles[2]); }

  /// Number of a point, (i·n₁ + j)·n₂ + k, and the point of a number.
  std::uint32_t index(const Place& p) const {
    return static_cast<std::uint32_t>((p[0] * particles[1] + p[1]) * particles[2] + p[2]);
  }
  Place place(std::size_t index) const {
    const auto at = static_cast<int>(index);
    return {at / (particles[1] * particles[2]), at / particles[2] % particles[1], at % particles[2]};
  }
  bool contains(const Place& p) const {
    return p[0] >= 0 && p[0] < particles[0] && p[1] >= 0 && p[1] < particles[1] && p[2] >= 0 &&
           p[2] < particles[2];
  }

  /// Whether the cell at these steps from the first is inside the lattice and full.
  bool full(const Place& cell) const;
  bool has_particle(const Place& place) const;
  /// Whether the spring of the particle at `place` in a direction exists.
  bool has_spring(const Place& place, const LatticeDirection& direction) const;

  friend bool operator==(const Lattice&, const Lattice&) = default;
};

/// The full cells that have both ends of a spring, row by row; of a spring over two steps, those of rows in
/// which both cells are full. None: there is no such spring.
struct SpringCells {
  std::array<Lattice::Place, 8> at = {};
  std::size_t count = 0;
};
SpringCells cells_along(const Lattice& lattice, const Lattice::Place& place,
                        const LatticeDirection& direction);

/// Where there is no particle.
inline constexpr std::uint32_t no_particle = 0xffffffffu;
/// By point: which of the lattice's particles it is, counted in the order of points, or no_particle.
std::vector<std::uint32_t> particle_numbers(const Lattice& lattice);

/// How many springs the lattice has in a direction; in no time where all cells are full.
std::uint64_t springs_along(const Lattice& lattice, const LatticeDirection& direction);

}  // namespace aspic
