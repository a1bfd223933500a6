#pragma once
#include "physics/vectors.h"

namespace aspic::physics {

/// Positions [m] and velocities [m/s] of all particles, or of all balls.
template <class T>
struct Phase {
  Field<T> x, v;
};

}  // namespace aspic::physics
