#include "model/quad_mesh.h"

#include <algorithm>

namespace aspic {
namespace {

/// Places along `quads` quads, the first and the last among them, with at most `most` gaps.
std::vector<std::uint32_t> places(std::uint32_t quads, std::uint32_t most) {
  const std::uint32_t gaps = std::min(quads, most);
  std::vector<std::uint32_t> result;
  for (std::uint64_t i = 0; i <= gaps; ++i) result.push_back(static_cast<std::uint32_t>(i * quads / gaps));
  return result;
}

/// The six sides of a lattice whose cells are all full.
QuadMesh surface_of_box(const Lattice& lattice, std::uint32_t first) {
  QuadMesh mesh;
  std::array<std::uint32_t, 3> count, stride;
  std::ranges::copy(lattice.particles, count.begin());
  std::ranges::copy(lattice.strides(), stride.begin());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    for (const bool high : {false, true})
      append_grid(mesh, {first + (high ? (count[axis] - 1) * stride[axis] : 0),
                         {count[i], count[j]},
                         {stride[i], stride[j]},
                         !high});
  }
  return mesh;
}

/// The same side of the cells, as far as it is on the surface.
void append_side(QuadMesh& mesh, const Lattice& lattice, const std::vector<std::uint32_t>& numbers,
                 std::uint32_t first, std::size_t axis, bool high) {
  const std::size_t before = mesh.quads.size(), u = (axis + 1) % 3, v = (axis + 2) % 3;
  const std::array<int, 3> cells = lattice.cells();
  for (Lattice::Place cell = {}; cell[0] < cells[0]; ++cell[0]) {
    for (cell[1] = 0; cell[1] < cells[1]; ++cell[1]) {
      for (cell[2] = 0; cell[2] < cells[2]; ++cell[2]) {
        Lattice::Place next = cell;
        next[axis] += high ? 1 : -1;
        if (!lattice.full(cell) || lattice.full(next)) continue;
        const auto corner = [&](int along_u, int along_v) {
          Lattice::Place at = cell;
          at[axis] += high;
          at[u] += along_u;
          at[v] += along_v;
          return first + numbers[lattice.index(at)];
        };
        mesh.quads.push_back(high ? Quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}
                                  : Quad{corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)});
      }
    }
  }
  mesh.groups.push_back({static_cast<std::uint32_t>(mesh.quads.size() - before)});
}

}  // namespace

void append_grid(QuadMesh& mesh, const ParticleGrid& grid) {
  const std::uint32_t ni = grid.count[0] - 1, nj = grid.count[1] - 1;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return grid.first + i * grid.stride[0] + j * grid.stride[1];
  };
  for (std::uint32_t i = 0; i < ni; ++i) {
    for (std::uint32_t j = 0; j < nj; ++j) {
      const Quad quad = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      mesh.quads.push_back(grid.clockwise ? Quad{quad[0], quad[3], quad[2], quad[1]} : quad);
    }
  }
  if (grid.clockwise)
    mesh.groups.push_back({ni * nj, {nj, ni}, {1, nj}});
  else
    mesh.groups.push_back({ni * nj, {ni, nj}, {nj, 1}});
}

QuadMesh surface_of(const Lattice& lattice, std::uint32_t first) {
  if (lattice.all_full()) return surface_of_box(lattice, first);
  QuadMesh mesh;
  const std::vector<std::uint32_t> numbers = particle_numbers(lattice);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) append_side(mesh, lattice, numbers, first, axis, high);
  return mesh;
}

std::vector<Quad> coarser(const NormalGroup& group, std::span<const Quad> quads, std::uint32_t most_along) {
  if (std::ranges::max(group.count) <= most_along) return {quads.begin(), quads.end()};
  const std::array<std::vector<std::uint32_t>, 2> at = {places(group.count[0], most_along),
                                                        places(group.count[1], most_along)};
  // A particle is corner 0 of the quad that begins there, and of the last another one.
  const auto particle = [&](std::uint32_t u, std::uint32_t v) {
    const bool end_u = u == group.count[0], end_v = v == group.count[1];
    const Quad& quad = quads[(u - end_u) * group.stride[0] + (v - end_v) * group.stride[1]];
    return quad[end_u ? (end_v ? 2 : 1) : (end_v ? 3 : 0)];
  };
  // In the order of the quads.
  const std::size_t outer = group.stride[0] >= group.stride[1] ? 0 : 1, inner = 1 - outer;
  std::vector<Quad> result;
  for (std::size_t i = 0; i + 1 < at[outer].size(); ++i) {
    for (std::size_t j = 0; j + 1 < at[inner].size(); ++j) {
      const std::size_t u = outer == 0 ? i : j, v = outer == 0 ? j : i;
      const std::uint32_t u0 = at[0][u], u1 = at[0][u + 1], v0 = at[1][v], v1 = at[1][v + 1];
      result.push_back({particle(u0, v0), particle(u1, v0), particle(u1, v1), particle(u0, v1)});
    }
  }
  return result;
}

}  // namespace aspic
