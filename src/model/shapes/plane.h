#pragma once
// Plane: d = n·(x − p).
#include "model/shapes/shape.h"

namespace aspic::shapes {

struct Plane : Shape {
  static constexpr std::string_view name = "plane", title = "plane", kernel = "plane";
  static constexpr GeometryKey keys[] = {
      {"point", GeometryKind::place, "A point of the plane.", Vec3{0.0, -1.0, 0.0}},
      {"normal", GeometryKind::direction, "Direction to the free side, of any length.", Vec3{0.0, 1.0, 0.0}}};
  static constexpr Vec3 drop = {0.0, 1.9, 0.0};

  template <class T>
  static TerrainGap<T> gap(const Geometry<T>& g, const Vec<T>& x) {
    const auto& [point, normal, unused] = g.vectors;
    return {dot(normal, x - point), normal};
  }

  static FlatPart flat(const Geometry<double>& g) { return {g.vectors[0], g.vectors[1]}; }
};

}  // namespace aspic::shapes
