#pragma once
// Terrain: the rows of the table of shapes, and terrain as the model holds it.
#include <span>
#include <string_view>

#include "model/model.h"
#include "model/shapes/table.h"

namespace aspic {

/// The formulas of a shape in one precision, with one order of operations, which the kernels follow.
template <class T>
struct ShapeFormulas {
  T (*distance)(const Geometry<T>&, const Vec<T>&);  ///< d alone, the same bits as gap's
  TerrainGap<T> (*gap)(const Geometry<T>&, const Vec<T>&);
};

/// One shape. Solvers, images, parser, --set, defaults, checks, documentation, the window's buttons and
/// verify iterate the table.
struct TerrainShapeRow {
  TerrainShape value;
  std::string_view name;    ///< in scene files
  std::string_view title;   ///< for people
  std::string_view kernel;  ///< of shaders/shapes/KERNEL.glsl
  std::span<const GeometryKey> keys;
  /// The center of a cube of edge 4 m, some tenths of a meter off the surface of the default shape, above
  /// a place on which it can fall: for checks and measurements.
  Vec3 drop;
  ShapeFormulas<float> in_single;
  ShapeFormulas<double> in_double;
  FlatPart (*flat)(const Geometry<double>&);  ///< see shapes::Shape, as the rest
  Vec3 (*surface)(const Geometry<double>&, double u, double v);
  bool glass;
  bool ball;

  template <class T>
  const ShapeFormulas<T>& formulas() const {
    if constexpr (std::is_same_v<T, float>) {
      return in_single;
    } else {
      return in_double;
    }
  }
};

/// The distance alone; once inlined, computations that only the normal needs are left out.
template <class S, class T>
[[gnu::flatten]] T distance_of(const Geometry<T>& g, const Vec<T>& x) {
  return S::template gap<T>(g, x).d;
}

/// The row of a shape's struct.
template <class S>
constexpr TerrainShapeRow shape_row(TerrainShape value) {
  return {value,
          S::name,
          S::title,
          S::kernel,
          S::keys,
          S::drop,
          {distance_of<S, float>, S::template gap<float>},
          {distance_of<S, double>, S::template gap<double>},
          S::flat,
          S::surface,
          S::glass,
          S::ball};
}

/// Every shape, in the order in which they are listed for users; its index is the enumerator's value.
#define ASPIC_SHAPE(name, Struct) shape_row<shapes::Struct>(TerrainShape::name),
inline constexpr TerrainShapeRow terrain_shapes[] = {ASPIC_TERRAIN_SHAPES(ASPIC_SHAPE)};
#undef ASPIC_SHAPE
static_assert([] {
  std::size_t index = 0;
  for (const TerrainShapeRow& row : terrain_shapes)
    if (static_cast<std::size_t>(row.value) != index++ || !is_listed(row.value)) return false;
  return true;
}());

/// The row of a shape.
constexpr const TerrainShapeRow& terrain_row(TerrainShape shape) {
  return terrain_shapes[static_cast<std::size_t>(shape)];
}

/// A shape's key of this name, or nullptr.
const GeometryKey* geometry_key(TerrainShape shape, std::string_view name);

/// Completes a terrain: absent geometry from the shape's defaults, absent restitution and friction from
/// `contact`, absent mass infinite; directions become unit vectors. Geometry that the shape does not have is
/// left out.
Terrain make_terrain(const TerrainSettings& settings, const ContactSettings& contact);

/// Where a moving terrain is, and how fast: its displacement [m] and velocity [m/s].
struct Pose {
  Vec3 offset, velocity;
};

/// At the time step·timestep. Solvers round it once to their precision.
Pose pose_at(const TerrainMotion& motion, double timestep, std::uint64_t step);

/// A terrain displaced to where it is at that time; itself if it does not move.
Terrain terrain_at(const Terrain& terrain, double timestep, std::uint64_t step);

/// Signed distance d(x) [m] of a point from the terrain, positive on the free side, and the normal there, in
/// double precision: for reports and images. Solvers evaluate the formulas in their own precision.
double signed_distance(const Terrain& terrain, const Vec3& x);
TerrainGap<double> terrain_gap(const Terrain& terrain, const Vec3& x);

/// The size of the numbers in a terrain's formulas [m], which bounds the rounding of distances.
double extent(const Terrain& terrain);

/// Approach speed below which a contact is at rest: max(v_s, 2|g|h) [m/s].
double resting_speed(const Model& model);

/// |g|h: speed gained by a step of free fall [m/s].
double fall_speed(const Model& model);

}  // namespace aspic
