#pragma once
// Where balls are.
#include "physics/vectors.h"

namespace aspic::physics {

/// Positions, velocities and angular velocities of all balls.
template <class T>
struct BallPhase {
  Field<T> x, v, omega;
};

}  // namespace aspic::physics
