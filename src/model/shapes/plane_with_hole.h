#pragma once
// A plane whose solid half-space is hollowed by a bowl: d = max(n·(x − p), R − |x − c|), the normal that of
// the larger, the plane's where they are equal.
#include <algorithm>
#include <numbers>

#include "model/shapes/bowl.h"
#include "model/shapes/plane.h"

namespace aspic::shapes {

struct PlaneWithHole : Shape {
  static constexpr std::string_view name = "plane-with-hole", title = "plane with a hole",
                                    kernel = "plane_with_hole";
  static constexpr GeometryKey keys[] = {
      {"point", GeometryKind::place, Plane::keys[0].meaning, Vec3{0.0, 0.0, 0.0}},
      {"normal", GeometryKind::direction, Plane::keys[1].meaning, Vec3{0.0, 1.0, 0.0}},
      {"center", GeometryKind::place, Bowl::keys[0].meaning, Vec3{2.0, 6.364, 1.0}},
      {"radius", GeometryKind::length, Bowl::keys[1].meaning, 9.0}};
  static constexpr Vec3 drop = {-4.0, 2.9, 1.0};  // onto the rim

  template <class T>
  static TerrainGap<T> gap(const Geometry<T>& g, const Vec<T>& x) {
    const auto& [point, normal, center] = g.vectors;
    const T radius = g.numbers[0];
    const T over_plane = dot(normal, x - point);
    const Vec<T> e = x - center;
    const T L = length(e);
    const T within_bowl = radius - L;
    if (!(within_bowl > over_plane)) return {over_plane, normal};
    if (L == T(0)) return {within_bowl, {0, 1, 0}};
    const T q = T(1) / L;
    return {within_bowl, -(q * e)};
  }

  static FlatPart flat(const Geometry<double>& g) { return {g.vectors[0], g.vectors[1]}; }

  /// The bowl below the plane: u around the normal, v from the bottom to the rim.
  static Vec3 surface(const Geometry<double>& g, double u, double v) {
    const auto& [point, normal, center] = g.vectors;
    const double radius = g.numbers[0];
    const double rim = std::acos(std::clamp(dot(normal, center - point) / radius, -1.0, 1.0));
    const double around = 2.0 * std::numbers::pi * u;
    const auto [first, second] = directions_across(normal);
    const Vec3 outwards = std::cos(around) * first + std::sin(around) * second;
    return center + radius * (std::sin(v * rim) * outwards - std::cos(v * rim) * normal);
  }
};

}  // namespace aspic::shapes
