#include "model/triangle_mesh.h"

#include <algorithm>

namespace aspic {

void Bounds::add(const Vec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], point[axis]);
    high[axis] = std::max(high[axis], point[axis]);
  }
}

bool Bounds::contains(const Bounds& other) const {
  for (int axis = 0; axis < 3; ++axis)
    if (other.low[axis] < low[axis] || other.high[axis] > high[axis]) return false;
  return true;
}

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds bounds;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) bounds.add(mesh.vertices[v]);
  return bounds;
}

double enclosed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  const Bounds bounds = bounds_of(mesh);
  const Vec3 middle = 0.5 * (bounds.low + bounds.high);
  double six_fold = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - middle, b = mesh.vertices[t[1]] - middle,
               c = mesh.vertices[t[2]] - middle;
    six_fold += dot(a, cross(b, c));
  }
  return six_fold / 6.0;
}

}  // namespace aspic
