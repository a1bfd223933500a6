#pragma once
// Torus: a ring of radius R around the axis a through the center c, and all that is nearer to it than r.
// With e = x − c and e⊥ = e − (e·a)a: d = √((|e⊥| − R)² + (e·a)²) − r. The normal points away from the ring.
// On the ring it is a; on the axis, where the normals from all sides meet, their mean: a, or −a below the
// center.
#include <numbers>

#include "model/shapes/shape.h"

namespace aspic::shapes {

struct Torus : Shape {
  static constexpr std::string_view name = "torus", title = "torus", kernel = "torus";
  static constexpr GeometryKey keys[] = {
      {"center", GeometryKind::place, "Center.", Vec3{0.0, -1.0, 0.0}},
      {"axis", GeometryKind::direction, "Axis of the ring, of any length.", Vec3{0.0, 1.0, 0.0}},
      {"major-radius", GeometryKind::length, "Radius of the ring.", 3.0},
      {"minor-radius", GeometryKind::length, "Radius of the tube along it.", 1.2}};
  static constexpr Vec3 drop = {0.3, 3.4, 0.2};

  template <class T>
  static TerrainGap<T> gap(const Geometry<T>& g, const Vec<T>& x) {
    const auto& [center, axis, unused] = g.vectors;
    const T R = g.numbers[0], r = g.numbers[1];
    const Vec<T> e = x - center;
    const T along = dot(e, axis);
    const Vec<T> across = e - along * axis;
    const T L = length(across);
    const T off = L - R;
    const T away = std::sqrt(off * off + along * along);
    const T d = away - r;
    if (away == T(0)) return {d, axis};
    if (L == T(0)) return {d, along < T(0) ? -axis : axis};
    const T q = T(1) / away;
    return {d, ((off * q) / L) * across + (along * q) * axis};
  }

  /// u around the axis, v around the tube.
  static Vec3 surface(const Geometry<double>& g, double u, double v) {
    const auto& [center, axis, unused] = g.vectors;
    const double around = 2.0 * std::numbers::pi * u, tube = 2.0 * std::numbers::pi * v;
    const auto [first, second] = directions_across(axis);
    const Vec3 outwards = std::cos(around) * first + std::sin(around) * second;
    return center + (g.numbers[0] + g.numbers[1] * std::cos(tube)) * outwards +
           (g.numbers[1] * std::sin(tube)) * axis;
  }
};

}  // namespace aspic::shapes
