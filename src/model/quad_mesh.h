#pragma once
// Surfaces of bodies as lists of indices.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "aspic/model.h"
#include "model/lattice.h"

namespace aspic {

/// Consecutive quads of a surface over which normals are smooth; where two groups meet, an edge may be sharp.
struct NormalGroup {
  std::uint32_t quads = 0;
  /// Of quads that are a grid: how many lie along the side from a quad's corner 0 to 1, and along that from
  /// corner 0 to 3; {0, 0} for all else.
  std::array<std::uint32_t, 2> count = {};
  std::array<std::uint32_t, 2> stride = {};  ///< of a grid: from a quad to the next along these sides
};

/// A surface: quads over global particle indices, group by group.
struct QuadMesh {
  std::vector<Quad> quads;
  std::vector<NormalGroup> groups;

  /// Calls act(group, its quads).
  template <class Act>
  void for_each_group(const Act& act) const {
    std::size_t first = 0;
    for (const NormalGroup& group : groups) {
      act(group, std::span(quads).subspan(first, group.quads));
      first += group.quads;
    }
  }
};

/// Particles in a grid: the one at (i, j), each below its count, is first + i·stride[0] + j·stride[1].
struct ParticleGrid {
  std::uint32_t first = 0;                   ///< global index
  std::array<std::uint32_t, 2> count = {};   ///< particles along i and j, ≥ 2
  std::array<std::uint32_t, 2> stride = {};  ///< index differences
  bool clockwise = false;                    ///< seen from outside, the turn from i to j
};
/// Adds the cells of a grid as a group, j running before i.
void append_grid(QuadMesh& mesh, const ParticleGrid& grid);

/// The faces of a lattice's full cells that no other full cell shares, in a group for each of the six sides
/// that they face: low and high x, y, z. `first`: the index of the lattice's first particle.
QuadMesh surface_of(const Lattice& lattice, std::uint32_t first);

/// The quads of a group, or larger ones over some of the same particles: of a grid at most `most_along` along
/// a side.
std::vector<Quad> coarser(const NormalGroup& group, std::span<const Quad> quads, std::uint32_t most_along);

}  // namespace aspic
