#pragma once
// The closest points of many triangles to a point, in columns that a backend may compute in vector lanes.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "collision/contact_batch.h"
#include "physics/contact/geometry.h"

namespace aspic::collision {

template <class T>
Vector<T> vector_of(const Row<T>& row) {
  return {row[0], row[1], row[2]};
}
template <class T>
Row<T> row_of(const Vector<T>& v) {
  return {v.x(), v.y(), v.z()};
}

template <class T>
struct ClosestPointBatch {
  std::size_t count = 0;
  Vector<T> P;  ///< the point [m]
  alignas(64) BatchLane<std::int32_t> triangle;
  // Results, as in ClosestPoint.
  alignas(64) std::array<BatchLane<T>, 3> e, N;
  alignas(64) BatchLane<T> b, c, L, z;
  alignas(64) BatchLane<std::int32_t> face, real;

  Vector<T> at(const std::array<BatchLane<T>, 3>& of, std::size_t n) const {
    return {of[0][n], of[1][n], of[2][n]};
  }
  ClosestPoint<T> point(std::size_t n, std::uint32_t side) const {
    return {static_cast<std::uint32_t>(triangle[n]),
            side,
            {b[n], c[n], face[n] != 0},
            at(e, n),
            L[n],
            at(N, n),
            z[n]};
  }
};

/// Triangles by the points of their corners, and the places of these [m].
template <class T>
struct FacesInSpace {
  std::span<const std::array<std::uint32_t, 4>> faces;
  std::span<const Row<T>> x;

  Face<T> operator[](std::uint32_t triangle) const {
    const auto& face = faces[triangle];
    return face_of<T>(vector_of(x[face[0]]), vector_of(x[face[1]]), vector_of(x[face[2]]));
  }
};

/// Fills in the results of the first `count`; of a triangle without area only `real`.
template <class T>
void closest_points_one_by_one(const FacesInSpace<T>& faces, ClosestPointBatch<T>& batch) {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const Face<T> face = faces[static_cast<std::uint32_t>(batch.triangle[n])];
    batch.real[n] = face.real;
    if (!face.real) continue;
    const ClosestPoint<T> seen = closest_point<T>(0, 0, face, batch.P);
    for (std::size_t c = 0; c < 3; ++c) {
      batch.e[c][n] = seen.e[static_cast<Eigen::Index>(c)];
      batch.N[c][n] = seen.N[static_cast<Eigen::Index>(c)];
    }
    batch.b[n] = seen.at.b;
    batch.c[n] = seen.at.c;
    batch.face[n] = seen.at.face;
    batch.L[n] = seen.L;
    batch.z[n] = seen.z;
  }
}

}  // namespace aspic::collision
