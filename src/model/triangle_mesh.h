#pragma once
// Triangles over shared vertices, as mesh files hold surfaces.
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "aspic/vec.h"

namespace aspic {

/// Three vertices by index, counterclockwise seen from outside where the mesh is oriented.
using Triangle = std::array<std::uint32_t, 3>;

/// A surface of triangles. Lengths are in the units of its file until voxelize() scales them.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;  ///< each index is below the number of vertices
  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

/// An axis-parallel box; of nothing, `low` is above `high`.
struct Bounds {
  Vec3 low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
              std::numeric_limits<double>::infinity()};
  Vec3 high = -low;

  void add(const Vec3& point);
  Vec3 extent() const { return high - low; }
  bool contains(const Bounds& other) const;
};

/// The box of the vertices that triangles use.
Bounds bounds_of(const TriangleMesh& mesh);

/// Of a closed mesh, the volume inside, negative where it is inside out; of an open one that of the cones
/// over its triangles from the middle of its box.
double enclosed_volume(const TriangleMesh& mesh);

/// Twice the area of a triangle along its normal.
inline Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a);
}

}  // namespace aspic
