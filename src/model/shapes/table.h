#pragma once
// The one list of terrain shapes. A shape is a file src/model/shapes/NAME.h, which has everything about it
// but its kernel, a file shaders/shapes/NAME.glsl with NAME_distance() and NAME_gap(), two lines here,
// and its enumerator in include/aspic/settings.h.
#include "model/shapes/bowl.h"
#include "model/shapes/plane.h"
#include "model/shapes/plane_with_hole.h"
#include "model/shapes/sphere.h"
#include "model/shapes/tilted_plane.h"
#include "model/shapes/torus.h"

/// Enumerator and struct of every shape, in the order in which they are listed for users.
#define ASPIC_TERRAIN_SHAPES(SHAPE) \
  SHAPE(plane, Plane)               \
  SHAPE(tilted_plane, TiltedPlane)  \
  SHAPE(sphere, Sphere)             \
  SHAPE(bowl, Bowl)                 \
  SHAPE(torus, Torus)               \
  SHAPE(plane_with_hole, PlaneWithHole)

namespace aspic {

/// Whether the list above has a shape; the compiler complains of one that it lacks.
constexpr bool is_listed(TerrainShape shape) {
#define ASPIC_SHAPE(name, Struct) \
  case TerrainShape::name:        \
    return true;
  switch (shape) { ASPIC_TERRAIN_SHAPES(ASPIC_SHAPE) }
#undef ASPIC_SHAPE
  return false;
}

}  // namespace aspic
