#pragma once
// Sphere: d = |x − c| − R, the normal outwards, (0, 1, 0) at the center.
#include <numbers>

#include "model/shapes/shape.h"

namespace aspic::shapes {

struct Sphere : Shape {
  static constexpr std::string_view name = "sphere", title = "sphere", kernel = "sphere";
  static constexpr GeometryKey keys[] = {{"center", GeometryKind::place, "Center.", Vec3{0.0, -1.0, 0.0}},
                                         {"radius", GeometryKind::length, "Radius.", 3.0}};
  static constexpr Vec3 drop = {0.4, 4.9, 0.2};
  static constexpr bool ball = true;

  template <class T>
  static TerrainGap<T> gap(const Geometry<T>& g, const Vec<T>& x) {
    const Vec<T>& center = g.vectors[0];
    const T radius = g.numbers[0];
    const Vec<T> e = x - center;
    const T L = length(e);
    const T d = L - radius;
    if (L == T(0)) return {d, {0, 1, 0}};
    const T q = T(1) / L;
    return {d, q * e};
  }

  /// Poles at ±y.
  static Vec3 surface(const Geometry<double>& g, double u, double v) {
    const double around = 2.0 * std::numbers::pi * u, polar = std::numbers::pi * v;
    return g.vectors[0] + g.numbers[0] * Vec3{std::sin(polar) * std::cos(around), std::cos(polar),
                                              std::sin(polar) * std::sin(around)};
  }
};

}  // namespace aspic::shapes
