#pragma once
// What the file of a terrain shape is made of.
#include <array>
#include <cstddef>
#include <string_view>

#include "aspic/settings.h"
#include "aspic/vec.h"

namespace aspic {

/// What a geometry key holds.
enum class GeometryKind {
  place,      ///< a point [m]
  direction,  ///< any length but zero in scenes, a unit vector in the model
  length      ///< [m], > 0
};

/// A key of a shape's geometry. Shapes that share a key give it the same kind; the first key of a shape is a
/// place.
struct GeometryKey {
  std::string_view name;  ///< in scene files
  GeometryKind kind;
  std::string_view meaning;  ///< one sentence
  GeometryValue value;       ///< where the shape is by default
};

/// Signed distance d [m], positive on the free side, and unit normal n towards the free side.
template <class T>
struct TerrainGap {
  T d;
  Vec<T> n;
};

/// An unbounded flat part of a surface.
struct FlatPart {
  Vec3 point;   ///< [m]
  Vec3 normal;  ///< unit, towards the free side
};

namespace shapes {

/// Two unit vectors at right angles to the unit vector n and to each other.
inline std::array<Vec3, 2> directions_across(const Vec3& n) {
  const Vec3 first = cross(n, std::abs(n.y) < 0.9 ? Vec3{0.0, 1.0, 0.0} : Vec3{0.0, 0.0, 1.0});
  const Vec3 unit = first / length(first);
  return {unit, cross(n, unit)};
}

/// What a shape has unless its file says otherwise.
struct Shape {
  /// The unbounded flat part of the surface: FlatPart(const Geometry<double>&).
  static constexpr std::nullptr_t flat = nullptr;
  /// The rest of the surface: the point at u, v in 0…1, Vec3(const Geometry<double>&, double u, double v).
  static constexpr std::nullptr_t surface = nullptr;
  /// Whether the surface is drawn as glass, for containers that hide what they hold.
  static constexpr bool glass = false;
  /// Whether it is a ball, vector 0 its center and number 0 its radius, whose shadow is drawn by formula.
  static constexpr bool ball = false;
};

}  // namespace shapes
}  // namespace aspic
