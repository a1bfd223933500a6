#include "model/lattice.h"

#include <algorithm>
#include <cstdlib>

namespace aspic {
namespace {

/// Calls take(place) for the points, or cells, of a grid in their order.
template <class Take>
void for_each_place(const std::array<int, 3>& count, const Take& take) {
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) take(Lattice::Place{i, j, k});
}

}  // namespace

bool Lattice::full(const Place& cell) const {
  const std::array<int, 3> count = cells();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cell[axis] < 0 || cell[axis] >= count[axis]) return false;
  return all_full() || full_cells[(static_cast<std::size_t>(cell[0]) * static_cast<std::size_t>(count[1]) +
                                   static_cast<std::size_t>(cell[1])) *
                                      static_cast<std::size_t>(count[2]) +
                                  static_cast<std::size_t>(cell[2])];
}

bool Lattice::has_particle(const Place& place) const {
  if (!contains(place)) return false;
  if (all_full()) return true;
  for (const int i : {-1, 0})
    for (const int j : {-1, 0})
      for (const int k : {-1, 0})
        if (full({place[0] + i, place[1] + j, place[2] + k})) return true;
  return false;
}

SpringCells cells_along(const Lattice& lattice, const Lattice::Place& place,
                        const LatticeDirection& direction) {
  const std::array<int, 3> steps = {direction.di, direction.dj, direction.dk};
  SpringCells found;
  // Rows of cells that have both ends on them: along an axis with steps their way, on the others either side.
  const int length = std::max({std::abs(steps[0]), std::abs(steps[1]), std::abs(steps[2])});
  for (int sides = 0; sides < 8; ++sides) {
    const std::size_t before = found.count;
    for (int n = 0; n < length; ++n) {
      Lattice::Place cell = place;
      bool twice = false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int side = sides >> axis & 1;
        twice = twice || (side == 1 && steps[axis] != 0);
        cell[axis] += steps[axis] == 0 ? -side : steps[axis] > 0 ? n : -1 - n;
      }
      if (twice || !lattice.full(cell)) {
        found.count = before;
        break;
      }
      found.at[found.count++] = cell;
    }
  }
  return found;
}

bool Lattice::has_spring(const Place& place, const LatticeDirection& direction) const {
  if (!contains(place) ||
      !contains({place[0] + direction.di, place[1] + direction.dj, place[2] + direction.dk}))
    return false;
  return all_full() || cells_along(*this, place, direction).count > 0;
}

std::vector<std::uint32_t> particle_numbers(const Lattice& lattice) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(lattice.points());
  std::uint32_t next = 0;
  for_each_place(lattice.particles, [&](const Lattice::Place& place) {
    numbers.push_back(lattice.has_particle(place) ? next++ : no_particle);
  });
  return numbers;
}

std::uint64_t springs_along(const Lattice& lattice, const LatticeDirection& direction) {
  const std::array<int, 3> steps = {direction.di, direction.dj, direction.dk};
  std::uint64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    count *= static_cast<std::uint64_t>(std::max(0, lattice.particles[axis] - std::abs(steps[axis])));
  if (lattice.all_full()) return count;
  count = 0;
  for_each_place(lattice.particles,
                 [&](const Lattice::Place& place) { count += lattice.has_spring(place, direction); });
  return count;
}

}  // namespace aspic
