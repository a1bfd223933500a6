#pragma once
// Where balls are.
#include "cpu_reference/vectors.h"

namespace aspic::reference {

/// Positions, velocities and angular velocities of all balls.
template <class T>
struct BallPhase {
  Field<T> x, v, omega;
};

}  // namespace aspic::reference
