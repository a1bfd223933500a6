#pragma once
// The one list of terrain shapes. A shape is a file src/model/shapes/NAME.h, which has everything about it
// but its kernel, a file shaders/shapes/NAME.glsl with NAME_distance() and NAME_gap(), and two lines here.
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

#define ASPIC_SHAPE(name, Struct) name,
enum class TerrainShape { ASPIC_TERRAIN_SHAPES(ASPIC_SHAPE) };
#undef ASPIC_SHAPE

}  // namespace aspic
