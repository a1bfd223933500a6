#include "mesh/occupancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>

namespace aspic {
namespace {

constexpr std::array<std::array<int, 3>, 6> faces = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

/// By cell the piece that it is in, from 1 on; 0: none. Their sizes, by piece − 1.
std::vector<std::size_t> number_pieces(const OccupancyGrid& grid, std::vector<std::uint32_t>& piece) {
  piece.assign(grid.full.size(), 0);
  std::vector<std::size_t> sizes, open;
  for (std::size_t start = 0; start < grid.full.size(); ++start) {
    if (grid.full[start] == 0 || piece[start] != 0) continue;
    const auto number = static_cast<std::uint32_t>(sizes.size() + 1);
    std::size_t size = 0;
    piece[start] = number;
    open.push_back(start);
    while (!open.empty()) {
      const auto [i, j, k] = grid.place(open.back());
      open.pop_back();
      ++size;
      for (const auto& [di, dj, dk] : faces) {
        if (!grid.is_full(i + di, j + dj, k + dk)) continue;
        const std::size_t next = grid.index(i + di, j + dj, k + dk);
        if (piece[next] != 0) continue;
        piece[next] = number;
        open.push_back(next);
      }
    }
    sizes.push_back(size);
  }
  return sizes;
}

}  // namespace

std::array<int, 3> OccupancyGrid::place(std::size_t index) const {
  const auto m = static_cast<std::size_t>(cells[1]), l = static_cast<std::size_t>(cells[2]);
  return {static_cast<int>(index / (m * l)), static_cast<int>(index / l % m), static_cast<int>(index % l)};
}

std::size_t OccupancyGrid::full_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(full, [](std::uint8_t f) { return f != 0; }));
}

Lattice lattice_of(const OccupancyGrid& grid) {
  Lattice lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) lattice.particles[axis] = grid.cells[axis] + 1;
  lattice.full_cells.assign(grid.full.begin(), grid.full.end());
  if (std::ranges::all_of(lattice.full_cells, [](bool f) { return f; })) lattice.full_cells.clear();
  return lattice;
}

Result<std::vector<std::size_t>> keep_pieces(OccupancyGrid& grid, Pieces pieces) {
  std::vector<std::uint32_t> piece;
  std::vector<std::size_t> sizes = number_pieces(grid, piece);
  const auto largest = static_cast<std::uint32_t>(std::ranges::max_element(sizes) - sizes.begin()) + 1;
  std::vector<std::size_t> sorted = sizes;
  std::ranges::sort(sorted, std::ranges::greater());
  if (sizes.size() > 1 && pieces == Pieces::refuse) {
    const auto shown = std::span(sorted).first(std::min<std::size_t>(sorted.size(), 5));
    return advised(
        fail(ErrorCode::scene_rejected, "the cells form {} pieces that share no face: of {}{} cells",
             sizes.size(), fmt::join(shown, ", "), shown.size() < sorted.size() ? ", …" : ""),
        {advice("keep the largest or all of them with the key 'pieces'"), advice("use more cells")});
  }
  if (pieces == Pieces::largest)
    for (std::size_t i = 0; i < grid.full.size(); ++i)
      if (piece[i] != largest) grid.full[i] = 0;
  return sorted;
}

std::size_t count_hinges(const OccupancyGrid& grid) {
  std::size_t count = 0;
  const auto full = [&](std::array<int, 3> at) { return grid.is_full(at[0], at[1], at[2]); };
  for (int i = 0; i <= grid.cells[0]; ++i) {
    for (int j = 0; j <= grid.cells[1]; ++j) {
      for (int k = 0; k <= grid.cells[2]; ++k) {
        // The edges from this point downwards: four cells around each, of which two opposite ones are full.
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 3> a = {i, j, k};
          a[axis] -= 1;
          std::array<int, 3> b = a, c = a, d = a;
          b[u] -= 1;
          c[v] -= 1;
          d[u] -= 1;
          d[v] -= 1;
          if ((full(a) && full(d) && !full(b) && !full(c)) || (full(b) && full(c) && !full(a) && !full(d)))
            ++count;
        }
        // The point: eight cells around it, of which two opposite ones are full and no other.
        int around = 0, opposite = 0;
        for (int n = 0; n < 8; ++n) {
          const bool one = full({i - (n & 1), j - (n >> 1 & 1), k - (n >> 2)});
          const bool other = full({i - 1 + (n & 1), j - 1 + (n >> 1 & 1), k - 1 + (n >> 2)});
          around += one ? 1 : 0;
          opposite += one && other ? 1 : 0;
        }
        if (around == 2 && opposite == 2) ++count;
      }
    }
  }
  return count;
}

}  // namespace aspic
