#pragma once
// A mesh that follows the cells of a body.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/lattice.h"
#include "model/triangle_mesh.h"

namespace aspic {

/// Where a vertex is in a full cell: 0 … 1 along each edge inside, outside by at most half a cell.
struct SkinVertex {
  std::array<int, 3> cell = {};  ///< steps from the first
  Vec3 at;                       ///< −½ … 1½

  friend bool operator==(const SkinVertex&, const SkinVertex&) = default;
};

/// The vertices of a mesh bound to cells.
struct SkinBinding {
  std::vector<SkinVertex> vertices;
  std::size_t clamped = 0;  ///< were farther than half a cell from every full cell, and were moved to it
};

/// Binds each vertex to the full cell outside of which it is least, along the axis where it is most; of equal
/// ones to that with the smaller sum over the axes, then to the first. At least one cell is full.
SkinBinding bind_skin(const Lattice& lattice, std::span<const Vec3> vertices);

/// Trilinear weights of a cell's corners: that at (i, j, k) of it is number (i·2 + j)·2 + k. Their sum is 1.
std::array<double, 8> corner_weights(const Vec3& at);

/// By vertex, the numbers of its cell's eight corners, in that order: a value of `point_number` each, which
/// has one for each point of the lattice (particle_numbers()).
std::vector<std::array<std::uint32_t, 8>> skin_corners(const SkinBinding& binding, const Lattice& lattice,
                                                       std::span<const std::uint32_t> point_number);

/// Positions of the vertices where the lattice's corners are at `positions`, which has one for each number in
/// `corners`. An affine motion of the corners moves the skin exactly, up to rounding.
std::vector<Vec3> skin_positions(const SkinBinding& binding,
                                 std::span<const std::array<std::uint32_t, 8>> corners,
                                 std::span<const Vec3> positions);

/// Unit normals of vertices: the mean of the triangles around each, weighted by area; 0 where that is 0.
std::vector<Vec3> skin_normals(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}  // namespace aspic
