#pragma once
// Bowl, the inside of a sphere: d = R − |x − c|, the normal inwards, (0, 1, 0) at the center.
#include "model/shapes/sphere.h"

namespace aspic::shapes {

struct Bowl : Shape {
  static constexpr std::string_view name = "bowl", title = "bowl", kernel = "bowl";
  static constexpr GeometryKey keys[] = {
      {"center", GeometryKind::place, Sphere::keys[0].meaning, Vec3{2.0, 7.0, 1.0}},
      {"radius", GeometryKind::length, Sphere::keys[1].meaning, 7.0}};
  static constexpr Vec3 drop = {2.3, 5.5, 1.2};
  static constexpr bool glass = true;
  static constexpr auto surface = Sphere::surface;

  template <class T>
  static TerrainGap<T> gap(const Geometry<T>& g, const Vec<T>& x) {
    const Vec<T>& center = g.vectors[0];
    const T radius = g.numbers[0];
    const Vec<T> e = x - center;
    const T L = length(e);
    const T d = radius - L;
    if (L == T(0)) return {d, {0, 1, 0}};
    const T q = T(1) / L;
    return {d, -(q * e)};
  }
};

}  // namespace aspic::shapes
